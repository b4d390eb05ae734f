#version 450
// RGB to HSV, to CIE Lab and back, and the differences.
layout(location = 0) in vec3 source;
layout(location = 0) out vec4 hsvOut;
layout(location = 1) out vec4 labOut;
layout(location = 2) out vec4 back;
vec3 hsv(vec3 c) {
    vec4 p = c.g < c.b ? vec4(c.bg, -1.0, 2.0 / 3.0) : vec4(c.gb, 0.0, -1.0 / 3.0);
    vec4 q = c.r < p.x ? vec4(p.xyw, c.r) : vec4(c.r, p.yzx);
    float d = q.x - min(q.w, q.y);
    return vec3(abs(q.z + (q.w - q.y) / (6.0 * d + 1e-10)), d / (q.x + 1e-10), q.x);
}
vec3 rgb(vec3 c) {
    vec3 p = abs(fract(c.xxx + vec3(1.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0);
    return c.z * mix(vec3(1.0), clamp(p - 1.0, 0.0, 1.0), c.y);
}
float f(float t) { return t > 0.008856 ? pow(t, 1.0 / 3.0) : 7.787 * t + 16.0 / 116.0; }
vec3 lab(vec3 c) {
    const mat3 toXyz = mat3(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505);
    vec3 xyz = toXyz * c / vec3(0.9505, 1.0, 1.089), t = vec3(f(xyz.x), f(xyz.y), f(xyz.z));
    return vec3(116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z));
}
void main() {
    vec3 c = clamp(abs(source), 0.0, 1.0), h = hsv(c);
    hsvOut = vec4(h, 1.0);
    labOut = vec4(lab(c), atan(h.y, h.z));
    back = vec4(rgb(h), distance(c, rgb(h)));
}
