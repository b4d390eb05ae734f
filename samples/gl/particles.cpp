// A fountain of 8192 particles: a compute program moves them, a vertex program turns each into a square that faces the
// eye.
//
//   glBindBufferBase(GL_SHADER_STORAGE_BUFFER)    vnBindBuffer (set, binding), for dispatches and draws alike
//   glDispatchCompute                             vnDispatch, outside of a pass
//   glMemoryBarrier                               nothing: commands take effect in order
//   GL_POINTS and gl_PointSize, point sprites     instances of a strip of four vertices, made from gl_VertexIndex
//   glBlendFunc(GL_SRC_ALPHA, GL_ONE)             VnBlendStateDesc
//   glDepthMask(GL_FALSE)                         VnDepthStencilStateDesc::depthWrite = 0
#include "samples/common/app.h"
#include "samples/common/camera.h"

namespace {

constexpr uint32_t kCount = 8192;
constexpr double kStep = 1 / 60.0;

constexpr const char* kMove = R"(#version 450
layout(local_size_x = 64) in;
struct Particle { vec4 place; vec4 velocity; };  // place.w: age in seconds, velocity.w: life
layout(set = 0, binding = 0) buffer Particles { Particle particles[]; };
layout(push_constant) uniform Push { float step; uint round; };
uint hash(uint x) {  // the low-bias mixer of Wellons
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}
float random(inout uint seed) {
    seed = hash(seed + 0x9e3779b9u);
    return float(seed >> 8) / 16777216.0;
}
void main() {
    uint index = gl_GlobalInvocationID.x;
    Particle p = particles[index];
    p.place.w += step;
    if (p.place.w >= p.velocity.w) {  // born again
        uint seed = hash(index * 7919u + round);
        float angle = random(seed) * 6.2831853, tilt = sqrt(random(seed)) * 0.22;
        float speed = 6.2 + random(seed);
        p.velocity = vec4(vec3(cos(angle) * tilt, 1, sin(angle) * tilt) * speed, 1.5 + random(seed));
        p.place = vec4(0, 0.1, 0, random(seed) * step);
    }
    p.velocity.y -= 9.81 * step;
    p.place.xyz += p.velocity.xyz * step;
    if (p.place.y < 0.02 && p.velocity.y < 0) {  // bounces, and loses most of it
        p.place.y = 0.02;
        p.velocity.xyz *= vec3(0.7, -0.35, 0.7);
    }
    particles[index] = p;
})";

constexpr const char* kVertex = R"(#version 450
struct Particle { vec4 place; vec4 velocity; };
layout(set = 0, binding = 0) readonly buffer Particles { Particle particles[]; };
layout(push_constant) uniform Push { mat4 view; mat4 projection; };
layout(location = 0) out vec2 corner;
layout(location = 1) out vec3 tint;
void main() {
    Particle p = particles[gl_InstanceIndex];
    corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2 - 1;
    float youth = 1 - p.place.w / p.velocity.w;
    tint = mix(vec3(0.1, 0.2, 0.9), vec3(1.0, 0.75, 0.4), youth * youth) * youth;
    gl_Position = projection * (view * vec4(p.place.xyz, 1) + vec4(corner * 0.045, 0, 0));
})";

constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec2 corner;
layout(location = 1) in vec3 tint;
layout(location = 0) out vec4 color;
void main() {
    float falloff = max(1 - dot(corner, corner), 0);
    color = vec4(tint, falloff * falloff * 0.22);
})";

constexpr const char* kFloorVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 view; mat4 projection; };
layout(location = 0) in vec3 position;
layout(location = 0) out vec2 place;
void main() {
    place = position.xz;
    gl_Position = projection * view * vec4(position, 1);
})";

constexpr const char* kFloorFragment = R"(#version 450
layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;
void main() {
    vec2 cell = floor(place);
    float shade = mod(cell.x + cell.y, 2) * 0.01 + 0.02;
    color = vec4(vec3(shade) + vec3(0.25, 0.16, 0.08) * exp(-dot(place, place) * 0.5), 1);
})";

struct Particle {
    glm::vec4 place, velocity;
};

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Particles");
    VnContext context = app.context();
    // All are old at first, each a little more than the one before: they are born spread over two seconds.
    std::vector<Particle> start(kCount);
    for (uint32_t i = 0; i < kCount; ++i)
        start[i] = {{0, -10, 0, 0}, {0, 0, 0, 2 * static_cast<float>(i) / static_cast<float>(kCount)}};
    const VnBuffer particles = app.buffer(start);
    const samples::Mesh plane = app.mesh(samples::planeMesh(12));
    const VnProgram move = app.computeProgram(kMove), draw = app.program(kVertex, kFragment);
    const VnProgram floor = app.program(kFloorVertex, kFloorFragment);
    const VnVertexLayout positions =
        app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}}, {{sizeof(samples::MeshVertex), 0}});
    const VnDepthStencilState solid = app.depthState(), behindSolid = app.depthState(false);
    const VnBlendState add = app.blendState(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE);
    samples::OrbitCamera camera({0, 1.2f, 0}, 7.5f, 0.4, -0.15);
    uint32_t round = 0;

    return app.run([&](const samples::Frame& frame) {
        camera.update(frame.input);
        vnBindProgram(context, move);
        vnBindBuffer(context, 0, 0, 0, particles, 0, 0);
        // Steps of one length, so that the picture of a moment does not depend on the frames before.
        for (; round * kStep < frame.seconds; ++round) {
            struct {
                float step;
                uint32_t round;
            } push{static_cast<float>(kStep), round};
            app.push(push);
            vnDispatch(context, kCount / 64, 1, 1);
        }

        app.beginPass({0.004f, 0.005f, 0.01f, 1});
        struct {
            glm::mat4 view, projection;
        } push{camera.view(), samples::perspective(0.7, app.aspect(), 0.1, 60)};
        app.push(push);
        vnBindProgram(context, floor);
        vnBindVertexLayout(context, positions);
        vnBindDepthStencilState(context, solid);
        vnBindBlendState(context, VnBlendState{});
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
        app.draw(plane);
        vnBindProgram(context, draw);
        vnBindVertexLayout(context, VnVertexLayout{});
        vnBindDepthStencilState(context, behindSolid);
        vnBindBlendState(context, add);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 0);
        vnDraw(context, 4, kCount, 0, 0);
        app.endPass();
    });
}
