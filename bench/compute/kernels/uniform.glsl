#version 450
// Nearly everything follows from the push constants: matrices from angles, a light's colour from its temperature. What
// is left per pixel is one matrix product and one dot product.

layout(push_constant) uniform Parameters {
    vec4 angles;
    vec4 light;
} parameters;

mat3 rotation(vec3 axis, float angle) {
    float s = sin(angle), c = cos(angle), k = 1.0 - c;
    return mat3(axis.x * axis.x * k + c, axis.x * axis.y * k + axis.z * s, axis.x * axis.z * k - axis.y * s,
                axis.x * axis.y * k - axis.z * s, axis.y * axis.y * k + c, axis.y * axis.z * k + axis.x * s,
                axis.x * axis.z * k + axis.y * s, axis.y * axis.z * k - axis.x * s, axis.z * axis.z * k + c);
}

vec3 temperature(float kelvin) {
    float k = kelvin * 0.01;
    return clamp(vec3(1.29 * pow(max(k - 60.0, 1.0), -0.133), 0.39 * log(k) - 0.63, 0.54 * log(max(k - 10.0, 1.0)) - 1.2),
                 0.0, 1.0);
}

vec4 image(vec2 uv) {
    mat3 frame = rotation(normalize(vec3(1.0, 2.0, 3.0)), parameters.angles.x) *
                 rotation(normalize(vec3(-2.0, 1.0, 0.5)), parameters.angles.y) *
                 rotation(normalize(vec3(0.3, -1.0, 1.0)), parameters.angles.z);
    vec3 sun = normalize(vec3(cos(parameters.angles.w), sin(parameters.angles.w), 0.7));
    vec3 color = temperature(parameters.light.x);
    for (int i = 1; i <= 6; ++i) {
        frame = frame * rotation(sun, parameters.angles.x / float(i));
        color *= exp2(-parameters.light.y / float(i * i)) + 0.5 * pow(parameters.light.z, float(i));
    }
    frame = inverse(transpose(frame));
    vec3 n = frame * vec3(uv * 2.0 - 1.0, 1.0);
    return vec4(color * (0.5 + 0.25 * dot(n, sun)), 1.0);
}
