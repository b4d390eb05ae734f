#include "tests/vulkan/test_assembly.h"

namespace vernier::test {

std::string TwoBufferModule::text() const {
    return "OpCapability Shader\n" + head + R"(
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" )" +
           interface + "\nOpExecutionMode %main LocalSize " + std::to_string(localSize) + R"( 1 1
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %array ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %a DescriptorSet 0
OpDecorate %a Binding 0
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 1
)" + declarations +
           R"(
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%v3 = OpTypeVector %uint 3
%pid = OpTypePointer Input %v3
%id = OpVariable %pid Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%pblock = OpTypePointer StorageBuffer %block
%pu = OpTypePointer StorageBuffer %uint
%a = OpVariable %pblock StorageBuffer
%b = OpVariable %pblock StorageBuffer
%c0 = OpConstant %uint 0
)" + constants +
           R"(
%main = OpFunction %void None %fn
%entry = OpLabel
%gid = OpLoad %v3 %id
%i = OpCompositeExtract %uint %gid 0
)" + body +
           R"(
OpReturn
OpFunctionEnd
)";
}

VkShaderModule AssemblyTest::makeAssembledShader(const std::string& text, spv_target_env environment) {
    const spv_context context = spvContextCreate(environment);
    spv_binary binary = nullptr;
    EXPECT_EQ(spvTextToBinary(context, text.data(), text.size(), &binary, nullptr), SPV_SUCCESS) << text;
    const std::vector<uint32_t> words(binary->code, binary->code + binary->wordCount);
    spvBinaryDestroy(binary);
    spvContextDestroy(context);
    return makeShader(words);
}

AssemblyTest::Compute AssemblyTest::makeAssembled(const std::string& text, spv_target_env environment,
                                                  const std::vector<TestDescriptor>& descriptors) {
    Compute compute;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    compute.set = makeSet(descriptors, &setLayout);
    compute.layout = makeLayout({setLayout}, 0);
    compute.pipeline = makeComputePipeline(compute.layout, makeAssembledShader(text, environment));
    return compute;
}

}  // namespace vernier::test
