#version 450
// Ordered dithering with a computed Bayer matrix, to a palette of 3-3-2 bits packed into an integer.
layout(location = 0) in vec4 source;
layout(location = 0) out vec4 colour;
layout(location = 1) out uint code;
float bayer(uvec2 p) {
    uint value = 0u;
    for (uint bit = 0u; bit < 3u; ++bit) {
        uint x = (p.x >> bit) & 1u, y = (p.y >> bit) & 1u;
        value = bitfieldInsert(value, (x ^ y) << 1 | y, int(2u * (2u - bit)), 2);
    }
    return (float(value) + 0.5) / 64.0 - 0.5;
}
void main() {
    float threshold = bayer(uvec2(gl_FragCoord.xy));
    vec3 levels = vec3(7.0, 7.0, 3.0);
    vec3 quantised = clamp(round(source.rgb * levels + threshold), vec3(0.0), levels);
    uvec3 q = uvec3(quantised);
    code = q.r << 5 | q.g << 2 | q.b;
    colour = vec4(quantised / levels, 1.0);
}
