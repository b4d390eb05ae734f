#version 450
// Distance to a quadratic Bezier curve by Cardano's formula, and a B-spline by de Boor's algorithm in a local array.
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 colour;
float bezier(vec2 p, vec2 a, vec2 b, vec2 c) {
    vec2 u = b - a, v = a - 2.0 * b + c, w = u * 2.0, d = a - p;
    float k = 1.0 / dot(v, v), kx = k * dot(u, v), ky = k * (2.0 * dot(u, u) + dot(d, v)) / 3.0, kz = k * dot(d, u);
    float q = ky - kx * kx, q3 = q * q * q, r = kx * (2.0 * kx * kx - 3.0 * ky) + kz, h = r * r + 4.0 * q3;
    if (h >= 0.0) {
        h = sqrt(h);
        vec2 x = (vec2(h, -h) - r) / 2.0, uv = sign(x) * pow(abs(x), vec2(1.0 / 3.0));
        float t = clamp(uv.x + uv.y - kx, 0.0, 1.0);
        return length(d + (w + v * t) * t);
    }
    float z = sqrt(-q), angle = acos(r / (q * z * 2.0)) / 3.0, m = cos(angle), n = sin(angle) * 1.732050808;
    vec2 t = clamp(vec2(m + m, -n - m) * z - kx, 0.0, 1.0);
    vec2 e = d + (w + v * t.x) * t.x, g = d + (w + v * t.y) * t.y;
    return sqrt(min(dot(e, e), dot(g, g)));
}
vec2 deBoor(float t) {
    vec2 points[7] = vec2[](vec2(-0.9, -0.5), vec2(-0.6, 0.6), vec2(-0.2, -0.7), vec2(0.1, 0.5), vec2(0.4, -0.3), vec2(0.7, 0.8), vec2(0.9, 0.0));
    int k = clamp(int(t), 0, 3);
    vec2 d[4];
    for (int j = 0; j < 4; ++j) d[j] = points[k + j];
    for (int r = 1; r < 4; ++r)
        for (int j = 3; j >= r; --j) d[j] = mix(d[j - 1], d[j], (t - float(k + j - 3)) / float(4 - r));
    return d[3];
}
void main() {
    float curve = bezier(position, vec2(-0.8, -0.6), vec2(0.1, 0.9), vec2(0.8, -0.4));
    vec2 at = deBoor((position.x * 0.5 + 0.5) * 4.0);
    colour = vec4(curve, at, distance(at, position));
}
