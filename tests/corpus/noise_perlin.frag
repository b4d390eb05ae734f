#version 450
// Perlin's improved noise in three dimensions with a permutation table in a uniform buffer.
//! buffer 0 0 4096 integer 0 255
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 colour;
layout(set = 0, binding = 0) uniform Table { ivec4 permutation[64]; } table;
int lookup(int i) { return table.permutation[(i & 255) >> 2][i & 3]; }
float fade(float t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
float gradient(int hash, vec3 p) {
    int h = hash & 15;
    float u = h < 8 ? p.x : p.y, v = h < 4 ? p.y : (h == 12 || h == 14 ? p.x : p.z);
    return ((h & 1) == 0 ? u : -u) + ((h & 2) == 0 ? v : -v);
}
float noise(vec3 p) {
    ivec3 i = ivec3(floor(p)) & 255;
    p -= floor(p);
    vec3 f = vec3(fade(p.x), fade(p.y), fade(p.z));
    int a = lookup(i.x) + i.y, b = lookup(i.x + 1) + i.y;
    int aa = lookup(a) + i.z, ab = lookup(a + 1) + i.z, ba = lookup(b) + i.z, bb = lookup(b + 1) + i.z;
    float low = mix(mix(gradient(lookup(aa), p), gradient(lookup(ba), p - vec3(1, 0, 0)), f.x),
                    mix(gradient(lookup(ab), p - vec3(0, 1, 0)), gradient(lookup(bb), p - vec3(1, 1, 0)), f.x), f.y);
    float high = mix(mix(gradient(lookup(aa + 1), p - vec3(0, 0, 1)), gradient(lookup(ba + 1), p - vec3(1, 0, 1)), f.x),
                     mix(gradient(lookup(ab + 1), p - vec3(0, 1, 1)), gradient(lookup(bb + 1), p - vec3(1, 1, 1)), f.x), f.y);
    return mix(low, high, f.z);
}
void main() { colour = vec4(noise(position * 4.0), noise(position * 8.0), abs(noise(position * 16.0)), 1.0); }
