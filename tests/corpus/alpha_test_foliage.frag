#version 450
// Alpha-tested foliage: two-sided normals, translucency, discard with alpha sharpened by derivatives, depth written.
layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 tint;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform sampler2D leaves;
layout(push_constant) uniform Push { vec4 light; } push;
void main() {
    vec4 texel = texture(leaves, uv);
    float alpha = (texel.a - 0.3) / max(fwidth(texel.a), 1e-4) + 0.5;
    vec3 n = normalize(gl_FrontFacing ? normal : -normal), l = normalize(push.light.xyz);
    float wrap = (dot(n, l) + 0.5) / 1.5, back = pow(max(dot(-n, l), 0.0), 2.0);
    if (alpha < 0.5) discard;
    colour = vec4(texel.rgb * tint.rgb * (max(wrap, 0.0) + back * vec3(0.5, 0.7, 0.2)), clamp(alpha, 0.0, 1.0));
    gl_FragDepth = gl_FragCoord.z * 0.5 + 0.25 * texel.r;
}
