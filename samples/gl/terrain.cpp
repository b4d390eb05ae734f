// A landscape from a height map that the vertex shader reads, with water over it and haze in the distance.
//
//   texture() in a vertex shader              texelFetch of a vnBindTexture, like in any stage
//   glTexImage2D(GL_R32F)                     vnCreateImage with VK_FORMAT_R32_SFLOAT
//   GL_TRIANGLE_STRIP with glPrimitiveRestartIndex    vnSetTopology(..., 1): the largest index restarts
//   glPolygonMode(GL_FRONT_AND_BACK, GL_LINE) VnRasterStateDesc::polygonMode
//   glFog                                     a line in the fragment shader
//   glEnable(GL_BLEND)                        VnBlendStateDesc
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/random.h"

namespace {

constexpr uint32_t kSize = 257;  // samples of the height map on a side

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 eye; };
layout(set = 0, binding = 0) uniform sampler2D heights;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 normal;
float heightAt(ivec2 p) { return texelFetch(heights, clamp(p, ivec2(0), textureSize(heights, 0) - 1), 0).r; }
void main() {
    int size = textureSize(heights, 0).x;
    ivec2 p = ivec2(gl_VertexIndex % size, gl_VertexIndex / size);
    float dx = heightAt(p + ivec2(1, 0)) - heightAt(p - ivec2(1, 0));
    float dz = heightAt(p + ivec2(0, 1)) - heightAt(p - ivec2(0, 1));
    normal = vec3(-dx, 2, -dz);
    place = vec3(p.x - size / 2, heightAt(p), p.y - size / 2);
    gl_Position = viewProjection * vec4(place, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 eye; };
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(normal);
    vec3 sand = vec3(0.55, 0.45, 0.26), grass = vec3(0.12, 0.27, 0.06), rock = vec3(0.25, 0.22, 0.2), snow = vec3(0.9);
    vec3 albedo = mix(sand, grass, smoothstep(0.5, 3, place.y));
    albedo = mix(albedo, rock, smoothstep(0.8, 0.6, n.y));
    albedo = mix(albedo, snow, smoothstep(17, 22, place.y) * smoothstep(0.5, 0.75, n.y));
    float light = max(dot(n, normalize(vec3(0.6, 0.55, 0.4))), 0) * 1.1 + 0.12;
    float haze = 1 - exp(-distance(place, eye.xyz) * 0.0025);
    color = vec4(mix(albedo * light, vec3(0.5, 0.66, 0.85), haze), 1);
})";

constexpr const char* kWaterVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 eye; };
layout(location = 0) out vec3 place;
void main() {
    place = vec3(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 256 - 128, 0).xzy;
    gl_Position = viewProjection * vec4(place, 1);
})";

constexpr const char* kWaterFragment = R"(#version 450
layout(push_constant) uniform Push { mat4 viewProjection; vec4 eye; };
layout(location = 0) in vec3 place;
layout(location = 0) out vec4 color;
void main() {
    vec3 toEye = eye.xyz - place;
    float far = length(toEye), t = eye.w;
    vec3 n = normalize(vec3(sin(place.x * 1.7 + t) + sin(place.z * 2.3 - t * 1.3), 14, cos(place.z * 1.9 + place.x + t)));
    float mirror = pow(1 - max(dot(n, toEye / far), 0), 3);
    float glint = pow(max(dot(reflect(-toEye / far, n), normalize(vec3(0.6, 0.55, 0.4))), 0), 60);
    vec3 water = mix(vec3(0.01, 0.09, 0.14), vec3(0.4, 0.58, 0.8), mirror) + glint;
    float haze = 1 - exp(-far * 0.0025);
    color = vec4(mix(water, vec3(0.5, 0.66, 0.85), haze), 0.65 + 0.35 * mirror);
})";

/// Midpoint displacement on a square of 2^n + 1 (Fournier, Fussell, Carpenter 1982), steeper the higher it gets.
std::vector<float> landscape(uint64_t seed) {
    std::vector<float> height(size_t{kSize} * kSize);
    samples::Random random(seed);
    const auto at = [&](uint32_t x, uint32_t y) -> float& { return height[size_t{y} * kSize + x]; };
    float rough = 44;
    for (uint32_t step = kSize - 1; step > 1; step /= 2, rough *= 0.52f) {
        const uint32_t half = step / 2;
        for (uint32_t y = half; y < kSize; y += step)
            for (uint32_t x = half; x < kSize; x += step)
                at(x, y) = (at(x - half, y - half) + at(x + half, y - half) + at(x - half, y + half) +
                            at(x + half, y + half)) /
                               4 +
                           random.between(-rough, rough);
        for (uint32_t y = 0; y < kSize; y += half)
            for (uint32_t x = (y / half) % 2 ? 0 : half; x < kSize; x += step) {
                float sum = 0, count = 0;
                const auto add = [&](bool inside, uint32_t nx, uint32_t ny) {
                    if (inside) sum += at(nx, ny), ++count;
                };
                add(x >= half, x - half, y);
                add(x + half < kSize, x + half, y);
                add(y >= half, x, y - half);
                add(y + half < kSize, x, y + half);
                at(x, y) = sum / count + random.between(-rough, rough) * 0.7f;
            }
    }
    for (float& h : height) h = h > 0 ? h * (0.35f + h * 0.025f) : h * 0.4f;
    return height;
}

/// A strip for each row of squares, the rows parted by the restart index.
std::vector<uint32_t> strips() {
    std::vector<uint32_t> indices;
    for (uint32_t z = 0; z + 1 < kSize; ++z) {
        for (uint32_t x = 0; x < kSize; ++x) {
            indices.push_back(z * kSize + x);
            indices.push_back((z + 1) * kSize + x);
        }
        indices.push_back(0xFFFFFFFFu);
    }
    return indices;
}

}  // namespace

int main(int argc, char** argv) {
    bool wireframe = false;
    int seed = 4;
    samples::App app(argc, argv, "Terrain",
                     {{"--wireframe", "only the edges of the triangles", &wireframe, 'x'},
                      {"--seed", "another landscape for every number (4)", &seed}});
    VnContext context = app.context();
    const std::vector<uint32_t> indexData = strips();
    const VnBuffer indices = app.buffer(indexData);
    const samples::Target heights = app.target(VK_FORMAT_R32_SFLOAT, kSize, kSize);
    const std::vector<float> heightData = landscape(static_cast<uint64_t>(seed));
    vnUpdateImage(context, heights.image, nullptr, heightData.data(), heightData.size() * sizeof(float));
    const VnProgram ground = app.program(kVertex, kFragment), water = app.program(kWaterVertex, kWaterFragment);
    const VnDepthStencilState depth = app.depthState();
    const VnRasterState lines = app.rasterState(VK_CULL_MODE_NONE, VK_POLYGON_MODE_LINE);
    const VnBlendState over = app.blendState(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    const VnSampler nearest = app.sampler(VK_FILTER_NEAREST);
    samples::FlyCamera camera({10, 26, 118}, 0.25, -0.22);

    return app.run({0.5f, 0.66f, 0.85f, 1}, [&](const samples::Frame& frame) {
        camera.update(frame.input, frame.elapsed, 25);
        struct {
            glm::mat4 viewProjection;
            glm::vec4 eye;
        } push{samples::perspective(0.9, app.aspect(), 0.5, 500) * camera.view(),
               glm::vec4(camera.position(), static_cast<float>(frame.seconds))};
        app.push(push);
        vnBindDepthStencilState(context, depth);
        vnBindRasterState(context, wireframe ? lines : VnRasterState{});
        vnBindBlendState(context, VnBlendState{});
        vnBindProgram(context, ground);
        vnBindTexture(context, 0, 0, 0, heights.view, nearest);
        vnBindIndexBuffer(context, indices, 0, VK_INDEX_TYPE_UINT32);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 1);
        vnDrawIndexed(context, static_cast<uint32_t>(indexData.size()), 1, 0, 0, 0);

        vnBindRasterState(context, VnRasterState{});
        vnBindBlendState(context, over);
        vnBindProgram(context, water);
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 0);
        vnDraw(context, 4, 1, 0, 0);
    });
}
