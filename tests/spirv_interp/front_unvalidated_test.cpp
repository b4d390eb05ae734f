// What the lowering refuses by itself, of modules that nobody has validated.
#include <gtest/gtest.h>

#include "spirv_interp/front/lower_module.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

constexpr const char* kHead = R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %x %o
OpExecutionMode %main OriginUpperLeft
OpDecorate %x Location 0
OpDecorate %o Location 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%v3 = OpTypeVector %float 3
%pair = OpTypeStruct %float %int
%takes = OpTypeFunction %float %float
%pin = OpTypePointer Input %float
%pout = OpTypePointer Output %float
%x = OpVariable %pin Input
%o = OpVariable %pout Output
%one = OpConstant %float 1
%two = OpConstant %int 2
%true = OpConstantTrue %bool
%id = OpFunction %float None %takes
%p = OpFunctionParameter %float
%idb = OpLabel
OpReturnValue %p
OpFunctionEnd
%main = OpFunction %void None %fn
%entry = OpLabel
%v = OpLoad %float %x
)";

std::string errorOf(const std::string& body) {
    ShaderSource source;
    const Words words = assemble(std::string(kHead) + body + "OpFunctionEnd\n");
    source.words = words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = lowerAnyModule(source);
    return program.ok() ? "" : program.error().message;
}

TEST(Unvalidated, WhatIsValidIsLowered) {
    EXPECT_EQ(errorOf("%s = OpFAdd %float %v %one\nOpStore %o %s\nOpReturn\n"), "");
}

TEST(Unvalidated, WhatIsNotIsRefusedInWords) {
    struct Case {
        const char *body, *message;
    };
    const Case cases[] = {
        {"%s = OpFAdd %float %v %two\nOpStore %o %s\nOpReturn\n", "the operands of fadd are not of its types"},
        {"%s = OpIAdd %float %two %two\nOpStore %o %s\nOpReturn\n", "iadd are not of its types"},
        {"%s = OpIAdd %int %two %two\nOpStore %o %s\nOpReturn\n", "is not of the type that is asked for"},
        {"%s = OpVectorTimesScalar %v3 %v %one\nOpReturn\n", "a value has fewer components than are used"},
        {"%s = OpFunctionCall %float %id %two\nOpReturn\n", "is not of the type of the parameter"},
        {"%s = OpFunctionCall %int %id %one\nOpReturn\n", "the result is not of the function's type"},
        {"OpStore %o %later\n%later = OpFAdd %float %v %v\nOpReturn\n", "is used where it has no value"},
        {"%s = OpFAdd %float %v %v\n", "has no end"},
        {"OpBranch %next\n%next = OpLabel\nOpBranch %last\n%last = OpLabel\nOpBranch %next\n",
         "goes back to a block that is no loop header"},
        {"OpBranch %nowhere\n", "which is no block of the function"},
        {"OpBranchConditional %v %a %b\n%a = OpLabel\nOpReturn\n%b = OpLabel\nOpReturn\n", "a condition is no boolean"},
        {"%c = OpFOrdLessThan %bool %v %one\nOpSelectionMerge %b None\nOpBranchConditional %c %a %b\n%a = OpLabel\n"
         "%s = OpFAdd %float %v %v\nOpBranch %b\n%b = OpLabel\nOpStore %o %s\nOpReturn\n",
         "does not dominate the use"},
        {"%s = OpLoad %float %one\nOpReturn\n", "is not a pointer"},
        {"%s = OpAccessChain %pout %o %two\nOpReturn\n", "SPIR-V"},
        {"%s = OpCompositeConstruct %pair %one %one\nOpReturn\n", "is not of the type that is asked for"},
    };
    for (const Case& c : cases) {
        const std::string error = errorOf(c.body);
        EXPECT_NE(error.find(c.message), std::string::npos) << c.body << "gives: " << error;
    }
}

// Ids that are defined twice would let types contain themselves.
TEST(Unvalidated, IdsAreDefinedOnce) {
    Words words = assemble(std::string(kHead) + "OpReturn\nOpFunctionEnd\n");
    for (size_t at = 5; at < words.size(); at += words[at] >> 16) {
        // %pair, a structure of two members: of itself.
        if ((words[at] & 0xFFFF) != 30) continue;
        words.insert(words.begin() + static_cast<std::ptrdiff_t>(at + 4),
                     {4u << 16 | 30, words[at + 1], words[at + 1], words[at + 2]});
        break;
    }
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = lowerAnyModule(source);
    ASSERT_FALSE(program.ok());
    EXPECT_NE(program.error().message.find("is defined twice"), std::string::npos) << program.error().message;
}

}  // namespace
}  // namespace vernier::test
