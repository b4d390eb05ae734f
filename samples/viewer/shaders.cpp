#include "samples/viewer/shaders.h"

namespace samples::viewer_shaders {

static const std::string kModelPush = R"(#version 450
layout(push_constant) uniform Push {
    mat4 transform;
    vec4 eye, color, emission, surface;
};
)";

const std::string kModelVertex = kModelPush + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 worldNormal;
layout(location = 2) out vec2 uv;
void main() {
    place = position;
    worldNormal = normal;
    uv = textureCoordinate;
    gl_Position = transform * vec4(position, 1);
})";

const std::string kMappedVertex = kModelPush + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 textureCoordinate;
layout(location = 3) in vec4 tint;
layout(location = 4) in vec4 tangent;
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 worldNormal;
layout(location = 2) out vec2 uv;
layout(location = 3) out vec4 vertexColor;
layout(location = 4) out vec4 worldTangent;
void main() {
    place = position;
    worldNormal = normal;
    uv = textureCoordinate;
    vertexColor = tint;
    worldTangent = tangent;
    gl_Position = transform * vec4(position, 1);
})";

static const std::string kModelInputs = kModelPush + R"(
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 worldNormal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 result;
)";

// The highlight is Blinn and Phong's; metals colour it and have little else.
static const std::string kLight = R"(
const vec3 toLight = vec3(0.4682929, 0.7804881, 0.4136587);  // of length 1
vec4 lit(vec4 base) {
    vec3 normal = normalize(gl_FrontFacing ? worldNormal : -worldNormal);
    vec3 toEye = normalize(eye.xyz - place);
    float cosine = dot(normal, toLight) * 0.5 + 0.5;
    float highlight = pow(max(dot(normal, normalize(toLight + toEye)), 0), surface.y) * surface.z;
    vec3 diffuse = base.rgb * (1 - 0.6 * surface.x) * (cosine * cosine * 0.9 + 0.06);
    return vec4(diffuse + mix(vec3(0.25), base.rgb, surface.x) * highlight + emission.rgb, base.a);
}
)";

const std::string kModelFragment = kModelInputs + kLight + R"(
void main() { result = lit(texture(image, uv) * color); })";

const std::string kModelMaskedFragment = kModelInputs + kLight + R"(
void main() {
    vec4 base = texture(image, uv) * color;
    if (base.a < emission.w) discard;
    result = lit(vec4(base.rgb, 1));
})";

// The same light with maps of the surface. Where there is no tangent, normals are left as they are.
static const std::string kMapped = kModelInputs + R"(
layout(set = 0, binding = 1) uniform sampler2D surfaceMap;
layout(set = 0, binding = 2) uniform sampler2D emissionMap;
layout(set = 0, binding = 3) uniform sampler2D normalMap;
layout(location = 3) in vec4 vertexColor;
layout(location = 4) in vec4 worldTangent;
const vec3 toLight = vec3(0.4682929, 0.7804881, 0.4136587);  // of length 1
vec3 mappedNormal() {
    vec3 n = normalize(worldNormal), t = worldTangent.xyz - n * dot(n, worldTangent.xyz);
    vec3 seen = (texture(normalMap, uv).xyz * 2 - 1) * vec3(surface.w, surface.w, 1);
    if (dot(t, t) > 0) {
        t = normalize(t);
        n = normalize(t * seen.x + cross(n, t) * (worldTangent.w * seen.y) + n * seen.z);
    }
    return gl_FrontFacing ? n : -n;
}
vec4 mapped(vec4 base) {
    vec4 texel = texture(surfaceMap, uv);
    float metallic = surface.x * texel.b, roughness = clamp(surface.y * texel.g, 0.05, 1);
    float square = roughness * roughness, exponent = clamp(2 / (square * square) - 2, 1, 2000);
    vec3 normal = mappedNormal(), toEye = normalize(eye.xyz - place);
    float cosine = dot(normal, toLight) * 0.5 + 0.5;
    float highlight = pow(max(dot(normal, normalize(toLight + toEye)), 0), exponent) * (1 - roughness) * surface.z;
    vec3 diffuse = base.rgb * (1 - 0.6 * metallic) * (cosine * cosine * 0.9 + 0.06);
    vec3 glow = emission.rgb * texture(emissionMap, uv).rgb;
    return vec4(diffuse + mix(vec3(0.25), base.rgb, metallic) * highlight + glow, base.a);
}
)";

const std::string kMappedFragment = kMapped + R"(
void main() { result = mapped(texture(image, uv) * color * vertexColor); })";

const std::string kMappedMaskedFragment = kMapped + R"(
void main() {
    vec4 base = texture(image, uv) * color * vertexColor;
    if (base.a < emission.w) discard;
    result = mapped(vec4(base.rgb, 1));
})";

// A fragment that stands for 2x2 pixels has its place where they meet, at whole numbers.
static const std::string kCount = "    result = vec4(eye.w * (fract(gl_FragCoord.x) == 0 ? 0.25 : 1), 0, 0, 0);\n";

const std::string kCountFragment = kModelPush + R"(
layout(location = 0) out vec4 result;
void main() {
)" + kCount + "}";

const std::string kCountMaskedFragment = kModelInputs + R"(
void main() {
    if (texture(image, uv).a * color.a < emission.w) discard;
)" + kCount + "}";

const std::string kPlainFragment = kModelPush + R"(
layout(location = 0) out vec4 result;
void main() { result = color; })";

static const std::string kShow = R"(#version 450
layout(push_constant) uniform Push {
    vec4 bar;
    float scale, divide;
    int signs;
    float nearPlane, farPlane;
};
layout(location = 0) out vec4 result;
// Where the pixel lies on the legend's bar, 0..1; -1: not on it.
float onBar() {
    vec2 at = gl_FragCoord.xy;
    if (any(lessThan(at, bar.xy)) || any(greaterThan(at, bar.zw))) return -1;
    return (at.x - bar.x) / (bar.z - bar.x);
}
// Black, blue, purple, orange, yellow, white.
vec3 ramp(float t) {
    const vec3 colors[6] = vec3[](vec3(0), vec3(0.02, 0.05, 0.45), vec3(0.35, 0.02, 0.4), vec3(0.9, 0.2, 0.04),
                                  vec3(1, 0.75, 0.05), vec3(1));
    float at = clamp(t, 0, 1) * 5;
    int low = min(int(at), 4);
    return mix(colors[low], colors[low + 1], at - low);
}
// Blue for less, red for more, both towards white.
vec3 signedRamp(float t) {
    float size = min(abs(t), 1);
    vec3 strong = t < 0 ? vec3(0.02, 0.15, 1) : vec3(1, 0.1, 0.02), weak = vec3(0);
    return size < 0.5 ? mix(weak, strong, size * 2) : mix(strong, vec3(1), size * 2 - 1);
}
)";

const std::string kShowSplit = kShow + R"(
layout(set = 0, binding = 0) uniform sampler2D left;
layout(set = 0, binding = 1) uniform sampler2D right;
void main() {
    float x = gl_FragCoord.x;
    vec4 color = x < divide ? texelFetch(left, ivec2(gl_FragCoord.xy), 0)
                            : texelFetch(right, ivec2(gl_FragCoord.xy), 0);
    result = abs(x - divide) < 1 ? vec4(1, 0.8, 0.1, 1) : vec4(color.rgb, 1);
})";

const std::string kShowError = kShow + R"(
layout(set = 0, binding = 0) uniform sampler2D seen;
layout(set = 0, binding = 1) uniform sampler2D reference;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 error = texelFetch(seen, at, 0).rgb - texelFetch(reference, at, 0).rgb;
    vec3 size = abs(error);
    float worst = size.r >= size.g && size.r >= size.b ? error.r : size.g >= size.b ? error.g : error.b;
    float value = worst * 255 / scale;
    float place = onBar();
    if (place >= 0) value = signs != 0 ? place * 2 - 1 : place;
    result = vec4(signs != 0 ? signedRamp(value) : ramp(abs(value)), 1);
})";

const std::string kShowDepth = kShow + R"(
layout(set = 0, binding = 0) uniform sampler2D depths;
void main() {
    float depth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
    float distance = nearPlane * farPlane / (farPlane - depth * (farPlane - nearPlane));
    float place = onBar();
    float grey = 1 - clamp(place >= 0 ? place : distance / scale, 0, 1);
    result = vec4(depth == 1 && place < 0 ? vec3(0.01, 0.02, 0.08) : vec3(grey * grey), 1);
})";

const std::string kShowCount = kShow + R"(
layout(set = 0, binding = 0) uniform sampler2D counts;
void main() {
    float place = onBar();
    result = vec4(ramp(place >= 0 ? place : texelFetch(counts, ivec2(gl_FragCoord.xy), 0).r / scale), 1);
})";

const std::string kShowTiles = kShow + R"(
layout(set = 0, binding = 0) uniform sampler2D tiles;
layout(set = 0, binding = 1) uniform sampler2D picture;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float place = onBar();
    vec3 color = ramp(place >= 0 ? place : texelFetch(tiles, at / 64, 0).r / scale);
    // The picture stays to be seen below.
    float light = dot(texelFetch(picture, at, 0).rgb, vec3(0.3, 0.6, 0.1));
    if (place < 0) color = color * (0.6 + 0.4 * light) + 0.05 * light;
    if (place < 0 && (at.x % 64 == 0 || at.y % 64 == 0)) color += 0.06;
    result = vec4(color, 1);
})";

const std::string kSumTiles = R"(#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform sampler2D counts;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D tiles;
shared float rows[64];
void main() {
    ivec2 size = textureSize(counts, 0), first = ivec2(gl_WorkGroupID.xy) * 64;
    int y = first.y + int(gl_LocalInvocationIndex);
    float sum = 0;
    if (y < size.y)
        for (int x = first.x; x < min(first.x + 64, size.x); ++x) sum += texelFetch(counts, ivec2(x, y), 0).r;
    rows[gl_LocalInvocationIndex] = sum;
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        float all = 0;
        for (int row = 0; row < 64; ++row) all += rows[row];
        imageStore(tiles, ivec2(gl_WorkGroupID.xy), vec4(all));
    }
})";

}  // namespace samples::viewer_shaders
