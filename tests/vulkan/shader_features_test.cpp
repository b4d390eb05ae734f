// Features of shaders beyond the core of Vulkan 1.0: scalars of other widths and their storage, atomics, pointers,
// layouts, ways to end an invocation. Each is reported, and each is used through the whole driver.
#include <array>
#include <bit>
#include <cmath>

#include "tests/vulkan/test_assembly.h"

namespace vernier::test {
namespace {

/// The structures of a feature chain, all asked for.
struct FeatureChain {
    VkPhysicalDevice16BitStorageFeatures storage16{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES, nullptr, 1, 1, 1, 1};
    VkPhysicalDevice8BitStorageFeatures storage8{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_8BIT_STORAGE_FEATURES, &storage16, 1,
                                                 1, 1};
    VkPhysicalDeviceShaderFloat16Int8Features narrow{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES,
                                                     &storage8, 1, 1};
    VkPhysicalDeviceShaderAtomicInt64Features atomics{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_INT64_FEATURES,
                                                      &narrow, 1, 1};
    VkPhysicalDeviceVariablePointersFeatures pointers{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VARIABLE_POINTERS_FEATURES,
                                                      &atomics, 1, 1};
    VkPhysicalDeviceUniformBufferStandardLayoutFeatures uniforms{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_UNIFORM_BUFFER_STANDARD_LAYOUT_FEATURES, &pointers, 1};
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
                                                     &uniforms, 1};
    VkPhysicalDeviceShaderDemoteToHelperInvocationFeatures demote{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_DEMOTE_TO_HELPER_INVOCATION_FEATURES, &scalar, 1};
    VkPhysicalDeviceShaderTerminateInvocationFeatures terminate{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_TERMINATE_INVOCATION_FEATURES, &demote, 1};
    VkPhysicalDeviceShaderIntegerDotProductFeatures dot{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES, &terminate, 1};
    VkPhysicalDeviceShaderAtomicFloatFeaturesEXT floats{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT, &dot, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0};
    VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT moreFloats{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_2_FEATURES_EXT,
        &floats,
        0,
        0,
        0,
        1,
        1,
        0,
        0,
        0,
        1,
        1,
        1,
        0};

    FeatureChain() = default;
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;
};

class ShaderFeaturesTest : public AssemblyTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_STORAGE_BUFFER_STORAGE_CLASS_EXTENSION_NAME,
                VK_KHR_16BIT_STORAGE_EXTENSION_NAME,
                VK_KHR_8BIT_STORAGE_EXTENSION_NAME,
                VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME,
                VK_KHR_SHADER_ATOMIC_INT64_EXTENSION_NAME,
                VK_KHR_VARIABLE_POINTERS_EXTENSION_NAME,
                VK_KHR_UNIFORM_BUFFER_STANDARD_LAYOUT_EXTENSION_NAME,
                VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME,
                VK_EXT_SHADER_DEMOTE_TO_HELPER_INVOCATION_EXTENSION_NAME,
                VK_KHR_SHADER_TERMINATE_INVOCATION_EXTENSION_NAME,
                VK_KHR_SHADER_INTEGER_DOT_PRODUCT_EXTENSION_NAME,
                VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME,
                VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME,
                VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME,
                VK_KHR_SHADER_NON_SEMANTIC_INFO_EXTENSION_NAME};
    }
    void* moreFeatures() override { return &wanted_.moreFloats; }
    FeatureChain wanted_;
};

// Members that the tests below rely on come back set, others do not.
TEST_F(ShaderFeaturesTest, areReported) {
    const auto query = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceFeatures2KHR"));
    ASSERT_NE(query, nullptr);
    FeatureChain reported;
    auto features = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    features.pNext = &reported.moreFloats;
    reported.floats.sparseImageFloat32Atomics = reported.moreFloats.shaderBufferFloat16AtomicAdd = 1;
    reported.floats.shaderImageFloat32Atomics = reported.moreFloats.shaderImageFloat32AtomicMinMax = 0;
    reported.scalar.scalarBlockLayout = reported.storage16.storageInputOutput16 = reported.dot.shaderIntegerDotProduct =
        0;
    reported.narrow.shaderInt8 = reported.atomics.shaderSharedInt64Atomics =
        reported.demote.shaderDemoteToHelperInvocation = 0;
    query(physicalDevice, &features);
    EXPECT_TRUE(features.features.shaderInt16 && features.features.shaderInt64 && features.features.shaderFloat64);
    EXPECT_TRUE(reported.storage16.storageBuffer16BitAccess && reported.storage16.uniformAndStorageBuffer16BitAccess &&
                reported.storage16.storagePushConstant16 && reported.storage16.storageInputOutput16);
    EXPECT_TRUE(reported.floats.shaderBufferFloat32AtomicAdd && reported.floats.shaderSharedFloat64AtomicAdd);
    EXPECT_TRUE(reported.floats.shaderImageFloat32Atomics && reported.floats.shaderImageFloat32AtomicAdd &&
                reported.moreFloats.shaderImageFloat32AtomicMinMax);
    EXPECT_FALSE(reported.floats.sparseImageFloat32Atomics || reported.moreFloats.shaderBufferFloat16AtomicAdd);
    EXPECT_TRUE(reported.storage8.storagePushConstant8 && reported.narrow.shaderInt8 && reported.narrow.shaderFloat16);
    EXPECT_TRUE(reported.atomics.shaderBufferInt64Atomics && reported.atomics.shaderSharedInt64Atomics);
    EXPECT_TRUE(reported.pointers.variablePointers && reported.uniforms.uniformBufferStandardLayout &&
                reported.scalar.scalarBlockLayout);
    EXPECT_TRUE(reported.demote.shaderDemoteToHelperInvocation && reported.terminate.shaderTerminateInvocation &&
                reported.dot.shaderIntegerDotProduct);
}

TEST_F(ShaderFeaturesTest, floatControlsAreTold) {
    const auto query = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties2KHR"));
    auto controls =
        make<VkPhysicalDeviceFloatControlsProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES);
    auto properties = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &controls;
    query(physicalDevice, &properties);
    EXPECT_TRUE(controls.shaderDenormPreserveFloat16 && controls.shaderDenormPreserveFloat32 &&
                controls.shaderDenormPreserveFloat64);
    EXPECT_TRUE(controls.shaderRoundingModeRTEFloat16 && controls.shaderSignedZeroInfNanPreserveFloat32);
    EXPECT_FALSE(controls.shaderRoundingModeRTZFloat32 || controls.shaderDenormFlushToZeroFloat32);
}

constexpr const char* kTypes =
    "#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n#extension GL_EXT_shader_8bit_storage "
    ": require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_shader_atomic_int64 : require\n#extension GL_EXT_shader_atomic_float : require\n"
    "layout(local_size_x = 64) in;\n";

TEST_F(ShaderFeaturesTest, everyWidthComputesAndIsStored) {
    const TestBuffer bytes = makeStorage(64), shorts = makeStorage(64), wide = makeStorage(64 * 4);
    for (uint32_t i = 0; i < 256; ++i) static_cast<uint8_t*>(bytes.data)[i] = static_cast<uint8_t>(i * 5);
    for (uint32_t i = 0; i < 128; ++i) static_cast<uint16_t*>(shorts.data)[i] = static_cast<uint16_t>(0x3C00 + i);
    run(makeCompute(std::string(kTypes) + R"(
#pragma use_storage_buffer
layout(set = 0, binding = 0) buffer Bytes { int8_t b[]; };
layout(set = 0, binding = 1) buffer Shorts { float16_t h[]; };
layout(set = 0, binding = 2) buffer Wide { int64_t l[64]; double d[64]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    int8_t x = b[i];
    int16_t y = int16_t(x) * int16_t(300);
    b[i + 64] = x * int8_t(3);
    h[i + 64] = h[i] * 1.5hf;
    l[i] = int64_t(y) << 33;
    d[i] = double(h[i]) / 3.0lf;
})",
                    {storageBuffer(bytes), storageBuffer(shorts), storageBuffer(wide)}),
        1);
    for (uint32_t i = 0; i < 64; ++i) {
        const auto x = static_cast<int8_t>(i * 5);
        EXPECT_EQ(static_cast<int8_t*>(bytes.data)[i + 64], static_cast<int8_t>(x * 3));
        EXPECT_EQ(static_cast<uint8_t*>(bytes.data)[i + 128], static_cast<uint8_t>((i + 128) * 5));
        EXPECT_EQ(static_cast<int64_t*>(wide.data)[i],
                  static_cast<int64_t>(static_cast<int16_t>(x * 300)) * (int64_t{1} << 33));
        const double half = 1 + i / 1024.0;
        EXPECT_EQ(static_cast<double*>(wide.data)[64 + i], half / 3);
        // 1.5 * (1024 + i) units of 2^-10, to even.
        const double product = std::nearbyint(1.5 * (1024 + i));
        EXPECT_EQ(static_cast<uint16_t*>(shorts.data)[i + 64], 0x3C00 + static_cast<uint32_t>(product) - 1024) << i;
    }
}

TEST_F(ShaderFeaturesTest, wideAndFloatAtomicsAddUp) {
    const TestBuffer out = makeStorage(16);
    std::memset(out.data, 0, out.size);
    run(makeCompute(std::string(kTypes) + R"(
layout(set = 0, binding = 0) buffer Out { uint64_t sum; uint64_t greatest; float f; uint pad; double d; };
shared uint64_t mine;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0) mine = 0ul;
    barrier();
    atomicAdd(mine, (uint64_t(i) << 32) | 1ul);
    barrier();
    if (gl_LocalInvocationIndex == 0) { atomicAdd(sum, mine); atomicMax(greatest, mine); }
    atomicAdd(f, 0.5);
    atomicAdd(d, double(i));
})",
                    {storageBuffer(out)}),
        100);
    const auto* longs = static_cast<const uint64_t*>(out.data);
    uint64_t sum = 0, last = 0;
    for (uint64_t i = 0; i < 6400; ++i) sum += i << 32 | 1;
    for (uint64_t i = 6336; i < 6400; ++i) last += i << 32 | 1;
    EXPECT_EQ(longs[0], sum);
    EXPECT_EQ(longs[1], last);
    EXPECT_EQ(std::bit_cast<float>(words(out)[4]), 3200.0f);
    EXPECT_EQ(std::bit_cast<double>(longs[3]), 6399.0 * 3200);
}

// On texels of images and of buffers; a lane outside changes nothing.
TEST_F(ShaderFeaturesTest, floatAtomicsOnTexels) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(physicalDevice, VK_FORMAT_R32_SFLOAT, &properties);
    EXPECT_TRUE((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT) != 0 &&
                (properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT) != 0);
    const TestImage picture = makeImage(VK_FORMAT_R32_SFLOAT, {4, 2}, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestBuffer texels = makeBuffer(16, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    const float nan = std::nanf("");
    const float initial[4] = {100, -100, nan, 7};
    std::memcpy(texels.data, initial, sizeof initial);
    const TestBuffer out = makeStorage(8);
    const std::string head = std::string(kTypes) + R"(
#extension GL_EXT_shader_atomic_float2 : require
layout(set = 0, binding = 0, r32f) uniform image2D picture;
layout(set = 0, binding = 1, r32f) uniform imageBuffer texels;
layout(set = 0, binding = 2) buffer Out { float o[8]; };
)";
    const std::vector<TestDescriptor> descriptors{
        storageImage(picture), texelBuffer(makeTexels(texels, VK_FORMAT_R32_SFLOAT), true), storageBuffer(out)};
    const Compute clear = makeCompute(head + R"(
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < 8) imageStore(picture, ivec2(i % 4, i / 4), vec4(i));
})",
                                      descriptors);
    const Compute add = makeCompute(head + R"(
void main() {
    int i = int(gl_GlobalInvocationID.x);
    imageAtomicAdd(picture, ivec2(i % 5, i % 2), 0.5);
    imageAtomicMin(texels, 0, float(i) - 3.25);
    imageAtomicMax(texels, 1, i == 9 ? 0.0 / float(i - i) : float(i));
    imageAtomicMin(texels, 2, float(i + 1));
    imageAtomicMax(texels, i + 4, 1.0);
    if (i == 0) imageAtomicExchange(texels, 3, 0.125);
})",
                                    descriptors);
    const Compute read = makeCompute(head + R"(
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < 8) o[i] = imageLoad(picture, ivec2(i % 4, i / 4)).x;
})",
                                     descriptors);
    const VkCommandBuffer commands = begin();
    toGeneral(commands, picture);
    dispatch(commands, clear, 1);
    dispatch(commands, add, 10);
    dispatch(commands, read, 1);
    submit(commands);
    // Of 640 invocations every tenth adds to each place in the five columns, the last of which is outside.
    for (uint32_t i = 0; i < 8; ++i) EXPECT_EQ(std::bit_cast<float>(words(out)[i]), static_cast<float>(i) + 32.0f) << i;
    const auto* texel = static_cast<const float*>(texels.data);
    EXPECT_EQ(texel[0], -3.25f);
    EXPECT_EQ(texel[1], 639.0f);
    EXPECT_EQ(texel[2], 1.0f);
    EXPECT_EQ(texel[3], 0.125f);
}

TEST_F(ShaderFeaturesTest, narrowTypesInUniformsAndPushConstants) {
    TestDescriptor uniform;
    uniform.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const TestBuffer in = makeBuffer(16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT), out = makeStorage(6);
    uniform.buffer = in.buffer;
    struct Uniform {
        uint16_t x;
        int16_t number;
        int8_t byte;
    };
    struct Pushed {
        int16_t number;
        std::array<int8_t, 2> bytes;
    };
    *static_cast<Uniform*>(in.data) = {0x3E00, -1234, -7};  // 1.5
    const Pushed pushed{4321, {-7, 100}};
    const Compute compute = makeCompute(std::string(kTypes) + R"(
layout(set = 0, binding = 0) uniform In { float16_t x; int16_t number; int8_t byte; } u;
layout(set = 0, binding = 1) buffer Out { int o[]; };
layout(push_constant) uniform Push { int16_t number; int8_t bytes[2]; } p;
void main() {
    if (gl_LocalInvocationIndex != 0) return;
    o[0] = int(float(u.x) * 2.0);
    o[1] = u.number;
    o[2] = u.byte;
    o[3] = p.number;
    o[4] = p.bytes[0];
    o[5] = p.bytes[1];
})",
                                        {uniform, storageBuffer(out)}, 4);
    const VkCommandBuffer commands = begin();
    vkCmdPushConstants(commands, compute.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof pushed, &pushed);
    dispatch(commands, compute, 1);
    submit(commands);
    const auto* o = static_cast<const int32_t*>(out.data);
    EXPECT_EQ(std::vector<int32_t>(o, o + 6), (std::vector<int32_t>{3, -1234, -7, 4321, -7, 100}));
}

// Halves that are interpolated and a short that is not, from one stage to the next.
TEST_F(ShaderFeaturesTest, narrowTypesBetweenStages) {
    constexpr VkExtent2D kExtent{8, 4};
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = kExtent;
    const std::string head =
        "#version 450\n#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
        "#extension GL_EXT_shader_16bit_storage : require\n";
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, head + R"(
layout(location = 0) out f16vec2 place;
layout(location = 1) flat out int16_t number;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0;
    gl_Position = vec4(corner * 2.0 - 1.0, 0.5, 1);
    place = f16vec2(corner);
    number = int16_t(-300);
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, head + R"(
layout(location = 0) in f16vec2 place;
layout(location = 1) flat in int16_t number;
layout(location = 0) out vec4 o;
void main() { o = vec4(place, float(number) / -600.0, 1); })");
    drawTriangle(pass, makePipeline(pass.pass, desc));
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const auto at = [](uint32_t pixel, uint32_t count) {
                return static_cast<uint32_t>(std::lround(255.0 * (2 * pixel + 1) / (2 * count)));
            };
            const uint32_t expected = 0xFF800000u | at(y, kExtent.height) << 8 | at(x, kExtent.width);
            EXPECT_EQ(pixelAt(texels, color, x, y), expected) << x << ", " << y;
        }
    }
}

TEST_F(ShaderFeaturesTest, layoutsAreTakenAsTheyAre) {
    const TestBuffer in = makeBuffer(64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT), out = makeStorage(64);
    const float values[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    std::memcpy(in.data, values, sizeof values);
    run(makeCompute(std::string(kTypes) + R"(
layout(set = 0, binding = 0, scalar) buffer In { float a; vec3 b; vec3 c[2]; };
layout(set = 0, binding = 1, scalar) buffer Out { float o[]; };
void main() { uint i = gl_LocalInvocationIndex; if (i < 3) { o[i] = b[i] * 100 + c[1][i]; o[i + 3] = a; } })",
                    {storageBuffer(in), storageBuffer(out)}),
        1);
    for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(static_cast<float*>(out.data)[i], values[1 + i] * 100 + values[7 + i]);
        EXPECT_EQ(static_cast<float*>(out.data)[i + 3], 1.0f);
    }
}

// A pointer chosen between two buffers, a dot product of packed bytes, and an instruction that means nothing.
TEST_F(ShaderFeaturesTest, assemblyOnlyInstructions) {
    TwoBufferModule module;
    module.head = R"(
OpCapability VariablePointers
OpCapability DotProduct
OpCapability DotProductInput4x8BitPacked
OpExtension "SPV_KHR_storage_buffer_storage_class"
OpExtension "SPV_KHR_variable_pointers"
OpExtension "SPV_KHR_integer_dot_product"
OpExtension "SPV_KHR_non_semantic_info"
%set = OpExtInstImport "NonSemantic.Vernier.Test"
)";
    module.interface = "%id";
    module.localSize = 32;
    module.constants = R"(
%c1 = OpConstant %uint 1
%bytes = OpConstant %uint 0x04030201
)";
    module.body = R"(
%nothing = OpExtInst %void %set 7 %gid
%bit = OpBitwiseAnd %uint %i %c1
%odd = OpINotEqual %bool %bit %c0
%pa = OpAccessChain %pu %a %c0 %i
%pb = OpAccessChain %pu %b %c0 %i
%p = OpSelect %pu %odd %pa %pb
%v = OpLoad %uint %p
%d = OpUDot %uint %v %bytes PackedVectorFormat4x8Bit
OpStore %p %d
)";
    const TestBuffer a = makeStorage(32), b = makeStorage(32);
    for (uint32_t i = 0; i < 32; ++i) words(a)[i] = 0x01010101u * i, words(b)[i] = 0x01000000u * (i + 100);
    run(makeAssembled(module.text(), SPV_ENV_VULKAN_1_0, {storageBuffer(a), storageBuffer(b)}), 1);
    for (uint32_t i = 0; i < 32; ++i) {
        EXPECT_EQ(words(a)[i], i % 2 != 0 ? 10 * i : 0x01010101u * i);
        EXPECT_EQ(words(b)[i], i % 2 != 0 ? 0x01000000u * (i + 100) : 4 * (i + 100));
    }
}

// Of pointers into one buffer: the weaker capability.
TEST_F(ShaderFeaturesTest, pointersIntoOneBuffer) {
    TwoBufferModule module;
    module.head = R"(
OpCapability VariablePointersStorageBuffer
OpExtension "SPV_KHR_storage_buffer_storage_class"
OpExtension "SPV_KHR_variable_pointers"
)";
    module.interface = "%id";
    module.localSize = 4;
    module.constants = R"(
%c1 = OpConstant %uint 1
%c7 = OpConstant %uint 7
)";
    module.body = R"(
%bit = OpBitwiseAnd %uint %i %c1
%odd = OpINotEqual %bool %bit %c0
%mirror = OpISub %uint %c7 %i
%low = OpAccessChain %pu %a %c0 %i
%high = OpAccessChain %pu %a %c0 %mirror
%p = OpSelect %pu %odd %low %high
%v = OpLoad %uint %p
%pb = OpAccessChain %pu %b %c0 %i
OpStore %pb %v
)";
    const TestBuffer a = makeStorage(8), b = makeStorage(4);
    for (uint32_t i = 0; i < 8; ++i) words(a)[i] = 10 * i;
    run(makeAssembled(module.text(), SPV_ENV_VULKAN_1_0, {storageBuffer(a), storageBuffer(b)}), 1);
    EXPECT_EQ(std::vector<uint32_t>(words(b), words(b) + 4), (std::vector<uint32_t>{70, 10, 50, 30}));
}

// Formats beside those that every device has: stores convert, loads give back.
TEST_F(ShaderFeaturesTest, extendedFormatsOfStorageImages) {
    const TestImage halves = makeImage(VK_FORMAT_R16G16_SFLOAT, {4, 1}, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestImage bytes = makeImage(VK_FORMAT_R8_UINT, {4, 1}, VK_IMAGE_USAGE_STORAGE_BIT);
    const TestBuffer out = makeStorage(12);
    const Compute compute = makeCompute(R"(#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0, rg16f) uniform image2D halves;
layout(set = 0, binding = 1, r8ui) uniform uimage2D bytes;
layout(set = 0, binding = 2) buffer Out { uint v[12]; };
void main() {
    uint i = gl_LocalInvocationIndex;
    imageStore(halves, ivec2(i, 0), vec4(1.0 + i / 1024.0, 0.5 * i, 7, 7));
    imageStore(bytes, ivec2(i, 0), uvec4(i + 5));
    vec4 loaded = imageLoad(halves, ivec2(i, 0));
    v[i] = uint((loaded.x - 1.0) * 4096.0);
    v[4 + i] = uint(loaded.y * 2.0);
    v[8 + i] = imageLoad(bytes, ivec2(i, 0)).x;
})",
                                        {storageImage(halves), storageImage(bytes), storageBuffer(out)});
    const VkCommandBuffer commands = begin();
    toGeneral(commands, halves);
    toGeneral(commands, bytes);
    dispatch(commands, compute, 1);
    submit(commands);
    for (uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(words(out)[i], 4 * i);
        EXPECT_EQ(words(out)[4 + i], i);
        EXPECT_EQ(words(out)[8 + i], i + 5);
    }
}

// Pixels that are demoted or terminated keep the clear colour; a derivative beside them is what it was.
TEST_F(ShaderFeaturesTest, demoteAndTerminate) {
    constexpr VkExtent2D kExtent{16, 8};
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_EXT_demote_to_helper_invocation : require
#extension GL_EXT_terminate_invocation : require
layout(location = 0) out vec4 o;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    if (p.y == 5) terminateInvocation;
    if (p.x % 2 == 1) demote;
    float slope = dFdx(float(p.x * p.x));
    o = vec4(slope / 255.0, helperInvocationEXT() ? 1 : 0, 1, 1);
})");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    drawTriangle(pass, pipeline);
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const uint32_t slope = 2 * x + 1;  // of x^2 over the quad
            const uint32_t expected = y == 5 || x % 2 == 1 ? 0 : 0xFFFF0000u | slope;
            EXPECT_EQ(pixelAt(texels, color, x, y), expected) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace vernier::test
