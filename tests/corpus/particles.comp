#version 450
// Particle simulation: forces, collision with a plane and a sphere, respawn by a hash, death counted.
//! groups 2 1 1
//! buffer 0 0 4096 uniform -1 1
//! buffer 0 1 64 zero
//! push 64 uniform 0.1 1
layout(local_size_x = 64) in;
struct Particle { vec3 position; float age; vec3 velocity; float mass; };
layout(std430, set = 0, binding = 0) buffer Particles { Particle particles[]; };
layout(std430, set = 0, binding = 1) buffer Counter { uint deaths; };
layout(push_constant) uniform Push { float step; float drag; uint frame; } push;
float random(uint key) {
    key ^= key >> 16; key *= 0x7feb352du; key ^= key >> 15; key *= 0x846ca68bu;
    return float(key >> 8) / 16777216.0;
}
void main() {
    uint i = gl_GlobalInvocationID.x;
    Particle p = particles[i];
    float dt = push.step * 0.05;
    for (int k = 0; k < 4; ++k) {
        vec3 force = vec3(0.0, -9.8 * p.mass, 0.0) - p.velocity * push.drag;
        p.velocity += force / max(abs(p.mass), 0.1) * dt;
        p.position += p.velocity * dt;
        if (p.position.y < -1.0) {
            p.position.y = -2.0 - p.position.y;
            p.velocity = reflect(p.velocity, vec3(0.0, 1.0, 0.0)) * 0.6;
        }
        vec3 d = p.position - vec3(0.2, -0.3, 0.1);
        float r = length(d);
        if (r < 0.3) {
            vec3 n = d / r;
            p.position += n * (0.3 - r);
            p.velocity -= 1.5 * min(dot(p.velocity, n), 0.0) * n;
        }
        p.age += dt;
    }
    if (p.age > 0.8) {
        atomicAdd(deaths, 1u);
        p.age = 0.0;
        p.position = vec3(random(i), random(i + 1000u), random(i + 2000u));
        p.velocity = vec3(0.0);
    }
    particles[i] = p;
}
