// Atomic operations on floating-point numbers (VK_EXT_shader_atomic_float, _float2): each where it is the only one that
// the device has, as features that are kin stand in for each other where a shader is judged.
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

using Floats = VkPhysicalDeviceShaderAtomicFloatFeaturesEXT;
using MoreFloats = VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT;

enum class Place : uint8_t { buffer, shared, texels };

struct Case {
    const char* name;
    VkBool32 Floats::*feature;  // or
    VkBool32 MoreFloats::*moreFeature;
    Place place;
    const char* type;
    const char* operation;
    double expected;  // from 0, by 64 invocations
};

constexpr const char *kExchange = "Exchange(AT, T(1.25))", *kAdd = "Add(AT, T(0.5))",
                     *kMin = "Min(AT, T(i) - T(10.25))";
constexpr Case kCases[] = {
#define CASE(name, place, type, operation, expected) \
    { #name, &Floats::name, nullptr, Place::place, type, operation, expected }
#define MORE_CASE(name, place, type) \
    { #name, nullptr, &MoreFloats::name, Place::place, type, kMin, -10.25 }
    CASE(shaderBufferFloat32Atomics, buffer, "float", kExchange, 1.25),
    CASE(shaderBufferFloat32AtomicAdd, buffer, "float", kAdd, 32),
    CASE(shaderBufferFloat64Atomics, buffer, "double", kExchange, 1.25),
    CASE(shaderBufferFloat64AtomicAdd, buffer, "double", kAdd, 32),
    CASE(shaderSharedFloat32Atomics, shared, "float", kExchange, 1.25),
    CASE(shaderSharedFloat32AtomicAdd, shared, "float", kAdd, 32),
    CASE(shaderSharedFloat64Atomics, shared, "double", kExchange, 1.25),
    CASE(shaderSharedFloat64AtomicAdd, shared, "double", kAdd, 32),
    CASE(shaderImageFloat32Atomics, texels, "float", kExchange, 1.25),
    CASE(shaderImageFloat32AtomicAdd, texels, "float", kAdd, 32),
    MORE_CASE(shaderBufferFloat32AtomicMinMax, buffer, "float"),
    MORE_CASE(shaderBufferFloat64AtomicMinMax, buffer, "double"),
    MORE_CASE(shaderSharedFloat32AtomicMinMax, shared, "float"),
    MORE_CASE(shaderSharedFloat64AtomicMinMax, shared, "double"),
    MORE_CASE(shaderImageFloat32AtomicMinMax, texels, "float"),
#undef CASE
#undef MORE_CASE
};

/// The fixture as an object, of a device for one case.
class FloatAtomicLab : public ComputeTest {
  public:
    explicit FloatAtomicLab(const Case& one) : case_(one) {
        if (one.feature != nullptr) floats_.*one.feature = VK_TRUE;
        if (one.moreFeature != nullptr) more_.*one.moreFeature = VK_TRUE;
        SetUp();
    }
    ~FloatAtomicLab() override { TearDown(); }
    double result() {
        const TestBuffer out =
            makeBuffer(16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
        std::memset(out.data, 0, out.size);
        const bool texels = case_.place == Place::texels;
        run(makeCompute(glsl(),
                        {texels ? texelBuffer(makeTexels(out, VK_FORMAT_R32_SFLOAT), true) : storageBuffer(out)}),
            1);
        if (case_.type == std::string("double")) return *static_cast<const double*>(out.data);
        return static_cast<double>(*static_cast<const float*>(out.data));
    }

  private:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        floats_.pNext = &more_;
        return &floats_;
    }
    void TestBody() override {}
    std::string glsl() const {
        std::string operation = case_.operation;
        const bool texels = case_.place == Place::texels, shared = case_.place == Place::shared;
        operation.replace(operation.find("AT"), 2, texels ? "texels, 0" : shared ? "s" : "v");
        return std::string(R"(#version 450
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
#define T )") + case_.type +
               R"(
layout(local_size_x = 64) in;
)" +
               (texels ? "layout(set = 0, binding = 0, r32f) uniform imageBuffer texels;\n"
                       : "layout(set = 0, binding = 0) buffer Out { T v; };\n") +
               (shared ? "shared T s;\n" : "") + R"(
void main() {
    uint i = gl_LocalInvocationIndex;
)" + (shared ? "if (i == 0) s = T(0);\nbarrier();\n" : "") +
               (texels ? "imageAtomic" : "atomic") + operation + ";\n" +
               (shared ? "barrier();\nif (i == 0) v = s;\n" : "") + "}";
    }

    const Case& case_;
    Floats floats_ = make<Floats>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT);
    MoreFloats more_ = make<MoreFloats>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_2_FEATURES_EXT);
};

TEST(FloatAtomics, eachAloneOnItsDevice) {
    for (const Case& one : kCases) EXPECT_EQ(FloatAtomicLab(one).result(), one.expected) << one.name;
}

}  // namespace
}  // namespace vernier::test
