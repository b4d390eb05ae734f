#version 450
// Waves over a grid's cells, by the levels that the cells have.
//! buffer 0 0 256 uniform 0.5 2
layout(quads, equal_spacing) in;
layout(location = 0) in vec2 place[];
layout(location = 3) patch in vec4 wind;
layout(location = 0) out vec3 normal;
layout(location = 1) out float foam;
layout(std140, set = 0, binding = 0) uniform Sea { vec4 waves[8]; } sea;
void main() {
    vec2 p = mix(mix(place[0], place[1], gl_TessCoord.x), mix(place[3], place[2], gl_TessCoord.x), gl_TessCoord.y);
    float height = 0.0, coarse = max(gl_TessLevelInner[0], gl_TessLevelOuter[2]);
    vec2 slope = vec2(0);
    for (int n = 0; n < 8; ++n) {
        if (coarse * 2.0 < float(n) - 6.0) break;
        vec2 k = sea.waves[n].xy * wind.xy;
        float phase = dot(k, p) + sea.waves[n].z;
        height += sea.waves[n].w * sin(phase);
        slope += k * sea.waves[n].w * cos(phase);
    }
    gl_Position = vec4(p.x, height, p.y, 1.0);
    gl_ClipDistance[0] = height;
    normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    foam = smoothstep(0.5, 1.0, length(slope));
}
