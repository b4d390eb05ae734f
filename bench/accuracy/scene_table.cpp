// What each scene of accuracy draws.
#include "bench/accuracy/accuracy_scene.h"

namespace vernier::bench {
namespace {

// Vertex shaders, behind the mesh.
constexpr const char* kColored = R"(
layout(location = 0) out vec3 value;
void main() {
    ivec2 c = cornerCell();
    value = vec3(cornerHash(c.yx), cornerHash(c + 5), cornerHash(c.yx + 17)) / 1023.0;
    gl_Position = vec4(cornerPlace(c), 0.5, 1.0);
})";
constexpr const char* kFlatTriangles = R"(
layout(location = 0) flat out vec3 value;
void main() {
    int triangle = gl_VertexIndex / 3;
    value = vec3(triangle * 37 & 255, triangle * 91 & 255, triangle * 151 & 255) / 255.0;
    gl_Position = vec4(cornerPlace(cornerCell()), 0.5, 1.0);
})";
// Corners as a scan has them: anywhere between pixels, inner ones moved by up to 1/4 of a cell (else triangles turn
// over), in 8192 steps.
constexpr const char* kScanned = R"(
layout(location = 0) flat out vec3 value;
uint mixed(uint x) { x = (x ^ (x >> 16)) * 0x7FEB352Du; x = (x ^ (x >> 15)) * 0x846CA68Bu; return x ^ (x >> 16); }
void main() {
    ivec2 c = cornerCell();
    uint bits = mixed(uint(c.y) * 4096u + uint(c.x));
    vec2 moved = isInner(c) ? (vec2(bits & 8191u, (bits >> 13) & 8191u) - 4095.5) * 0.484375 / 8192.0 : vec2(0.0);
    int triangle = gl_VertexIndex / 3;
    value = vec3(triangle * 37 & 255, triangle * 91 & 255, triangle * 151 & 255) / 255.0;
    gl_Position = vec4((vec2(c) + moved) / vec2(cells) * 2.0 - 1.0, 0.5, 1.0);
})";
// A fan: every cell becomes a triangle from a point between pixels, off the middle, to a piece of the border, and one
// without area.
constexpr const char* kFan = R"(
layout(location = 0) flat out vec3 value;
vec2 border(int step) {  // cells.x steps a side, counter-clockwise; exact
    int side = (step / cells.x) % 4;
    float t = float(step % cells.x) / float(cells.x) * 2.0 - 1.0;
    return side == 0 ? vec2(t, -1.0) : side == 1 ? vec2(1.0, t) : side == 2 ? vec2(-t, 1.0) : vec2(-1.0, -t);
}
void main() {
    int cell = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
    value = vec3(cell * 37 & 255, cell * 91 & 255, cell * 151 & 255) / 255.0;
    vec2 place = corner == 1 ? border(cell) : corner == 2 ? border(cell + 1) : vec2(0.13771234, -0.09665432);
    gl_Position = vec4(place, 0.5, 1.0);
})";
// One instance a band of the target, each moved by another 1/64 of a pixel, as frames of a slow pan.
constexpr const char* kPan = R"(
layout(location = 0) flat out vec3 value;
void main() {
    ivec2 c = cornerCell();
    int triangle = gl_VertexIndex / 3;
    value = vec3(triangle * 37 & 255, triangle * 91 & 255, triangle * 151 & 255) / 255.0;
    vec2 place = cornerPlace(c);
    if (c.x > 0 && c.x < cells.x) place.x += float(gl_InstanceIndex) / 32.0 / size.x;
    gl_Position = vec4(place.x, (place.y + 1.0) / 16.0 + float(gl_InstanceIndex) / 8.0 - 1.0, 0.5, 1.0);
})";
// A floor seen at a grazing angle, as projected: w rises from 1 to 64, and (x, y, 1) * w keeps the mesh in its place.
constexpr const char* kFloor = R"(
layout(location = 0) out vec2 uv;
void main() {
    ivec2 c = cornerCell();
    vec2 place = cornerPlace(c);
    float w = c.y == 0 ? 64.0 : 1.0;
    uv = vec2(place.x * w, w) * 0.5;
    gl_Position = vec4(place * w, 0.5 * w, w);
})";
constexpr const char* kPerspectiveColors = R"(
layout(location = 0) out vec3 value;
void main() {
    ivec2 c = cornerCell();
    float w = 1.0 + float(cornerHash(c + 3) & 7);
    value = vec3(cornerHash(c.yx), cornerHash(c + 5), cornerHash(c.yx + 17)) / 1023.0;
    gl_Position = vec4(cornerPlace(c) * w, 0.5 * w, w);
})";
// Two sheets from 9 to 11 km; the second one, drawn last, is 2^-10 m nearer everywhere. Depth is reversed: z / w = 1/4
// / w.
constexpr const char* kSheets = R"(
layout(location = 0) flat out float sheet;
void main() {
    ivec2 c = cornerCell();
    float w = 9000.0 + float(cornerHash(c) * 2) - float(gl_InstanceIndex) / 1024.0;
    sheet = float(gl_InstanceIndex);
    vec2 place = vec2(c) / vec2(cells) * 2.0 - 1.0;
    gl_Position = vec4(place * w, 0.25, w);
})";
constexpr const char* kUv = R"(
layout(location = 0) out vec2 uv;
void main() {
    vec2 place = cornerPlace(cornerCell());
    uv = place * 0.5 + 0.5;
    gl_Position = vec4(place, 0.5, 1.0);
})";
constexpr const char* kLayers = R"(
layout(location = 0) flat out vec4 value;
void main() {
    int i = gl_InstanceIndex;
    value = vec4(i * 37 & 255, i * 91 & 255, i * 151 & 255, 8 + (i * 13 & 15)) / 255.0;
    gl_Position = vec4(cornerPlace(cornerCell()), 0.5, 1.0);
})";

// Fragment shaders.
constexpr const char* kShowColor = R"(
layout(location = 0) in vec3 value;
layout(location = 0) out vec4 color;
void main() { color = vec4(value, 1.0); })";
constexpr const char* kShowFlat = R"(
layout(location = 0) flat in vec3 value;
layout(location = 0) out vec4 color;
void main() { color = vec4(value, 1.0); })";
constexpr const char* kShowLayer = R"(
layout(location = 0) flat in vec4 value;
layout(location = 0) out vec4 color;
void main() { color = value; })";
constexpr const char* kShowSheet = R"(
layout(location = 0) flat in float sheet;
layout(location = 0) out vec4 color;
void main() { color = sheet > 0.5 ? vec4(1.0, 0.8, 0.2, 1.0) : vec4(0.1, 0.2, 0.5, 1.0); })";
constexpr const char* kTextured = R"(
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })";
constexpr const char* kMinified = R"(
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, mat2(0.921, 0.389, -0.389, 0.921) * uv * size / 24.0); })";
constexpr const char* kHash = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec2 cell = floor(uv * 64.0);
    float noise = fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.5453);
    color = vec4(noise, fract(noise * 7.0), 0.0, 1.0);
})";
constexpr const char* kTranscendental = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    float wave = sin(floor(uv.x * 128.0) * 12.9898 + floor(uv.y * 128.0) * 78.233);
    float gloss = pow(0.25 + 0.75 * uv.x, 8.0 * uv.y + 1.0);
    float decay = exp(-4.0 * uv.x) + log2(1.0 + uv.y);
    color = vec4(wave * 0.5 + 0.5, gloss, decay * 0.5, 1.0);
})";
constexpr const char* kSpecular = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = uv * 2.0 - 1.0;
    vec3 normal = normalize(vec3(p + 0.2 * vec2(sin(p.y * 9.0), cos(p.x * 7.0)), 1.0));
    vec3 light = normalize(vec3(0.4, 0.5, 0.8)), eye = normalize(vec3(-p, 2.0));
    float gloss = pow(max(dot(reflect(-light, normal), eye), 0.0), 48.0);
    color = vec4(vec3(0.1, 0.2, 0.4) * max(dot(normal, light), 0.0) + gloss, 1.0);
})";
constexpr const char* kPlasma = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = uv * 6.0 - 3.0;
    float angle = atan(p.y, p.x), radius = length(p);
    float wave = sin(radius * 4.0 - angle * 3.0) + cos(p.x * 2.0 + p.y);
    color = vec4(0.5 + 0.5 * sin(wave * vec3(1.0, 1.7, 2.3)), 1.0);
})";

constexpr VkFormat kFloat = VK_FORMAT_R32G32B32A32_SFLOAT, kByte = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkExtent2D kSmall{96, 64}, kLarge{768, 512};
constexpr auto kNoTexture = SceneTexture::none;

constexpr AccuracyScene kScenes[] = {
    {"far_triangles",
     "Triangles of a few pixels up to 4096 pixels from the origin, smooth colours.",
     "interpolation",
     {4096, 4},
     {4096, 128},
     kFloat,
     kColored,
     kShowColor,
     1024,
     1},
    {"jittered_mesh", "A mesh of flat triangles whose corners lie between pixels.", "sub-pixel bits", kSmall, kLarge,
     kFloat, kFlatTriangles, kShowFlat, 16, 16},
    {"scanned_mesh",
     "A scan: triangles of a few pixels whose corners lie anywhere between pixels.",
     "sub-pixel bits",
     {256, 128},
     {1024, 512},
     kFloat,
     kScanned,
     kShowFlat,
     64,
     32,
     1,
     1,
     kNoTexture,
     false,
     false,
     0,
     4},
    {"facets",
     "A model of flat facets some twenty pixels wide, as parts of machines are drawn.",
     "sub-pixel bits",
     {128, 128},
     {1024, 1024},
     kFloat,
     kScanned,
     kShowFlat,
     8,
     8,
     1,
     1,
     kNoTexture,
     false,
     false,
     0,
     8},
    {"walls",
     "A room of triangles hundreds of pixels long.",
     "sub-pixel bits",
     {256, 256},
     {1024, 1024},
     kFloat,
     kScanned,
     kShowFlat,
     2,
     2},
    {"sliver_fan", "A fan of 256 slivers around one point.", "sub-pixel bits", kSmall, kLarge, kFloat, kFan, kShowFlat,
     64, 4},
    {"slow_pan",
     "Sixteen bands of one mesh, each moved by another 1/64 pixel, as frames of a slow pan.",
     "sub-pixel bits, in motion",
     {128, 128},
     kLarge,
     kFloat,
     kPan,
     kShowFlat,
     16,
     4,
     16},
    {"layers", "A hundred translucent layers over each other in 8 bits.", "blending", kSmall, kLarge, kByte, kLayers,
     kShowLayer, 1, 1, 100, 100, kNoTexture, true},
    {"magnified_ramp",
     "A ramp of four texels over the whole target: 64 pixels a texel and more.",
     "filter weights",
     {256, 16},
     kLarge,
     kFloat,
     kUv,
     kTextured,
     1,
     1,
     1,
     1,
     SceneTexture::ramp},
    {"horizon", "A chequered floor to the horizon, trilinear.", "level of detail, perspective", kSmall, kLarge, kFloat,
     kFloor, kTextured, 1, 1, 1, 1, SceneTexture::checker},
    {"grazing_floor", "The same floor through an anisotropic filter of at most 16 samples.", "anisotropy", kSmall,
     kLarge, kFloat, kFloor, kTextured, 1, 1, 1, 1, SceneTexture::checker, false, false, 16},
    {"minified", "A turned chequered texture between two levels.", "level of detail", kSmall, kLarge, kFloat, kUv,
     kMinified, 1, 1, 1, 1, SceneTexture::checker},
    {"perspective_mesh", "Smooth colours over a mesh whose corners differ in distance by up to eight times.",
     "perspective division", kSmall, kLarge, kFloat, kPerspectiveColors, kShowColor, 8, 8},
    {"close_sheets", "Two sheets 1 mm apart at 10 km, depth reversed in D32.", "depth", kSmall, kLarge, kFloat, kSheets,
     kShowSheet, 4, 4, 2, 2, kNoTexture, false, true},
    {"hash_noise", "fract(sin(x) * 43758.5): noise that keeps only the last bits of a sine.", "functions", kSmall,
     kLarge, kFloat, kUv, kHash, 1, 1},
    {"transcendental", "Sines of large arguments, powers and logarithms per pixel.", "functions", kSmall, kLarge,
     kFloat, kUv, kTranscendental, 1, 1},
    {"specular", "A bumpy surface with a highlight: normalize, reflect, pow.", "functions; ordinary", kSmall, kLarge,
     kByte, kUv, kSpecular, 1, 1},
    {"plasma", "Coloured waves of sine, cosine and arc tangent.", "functions; ordinary", kSmall, kLarge, kByte, kUv,
     kPlasma, 1, 1},
    {"gradient", "A smooth 8-bit gradient over a mesh of large triangles.", "nothing; ordinary", kSmall, kLarge, kByte,
     kColored, kShowColor, 2, 2},
};

}  // namespace

std::span<const AccuracyScene> accuracySceneTable() {
    return kScenes;
}

}  // namespace vernier::bench
