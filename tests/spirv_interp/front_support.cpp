#include "tests/spirv_interp/front_support.h"

#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include "spirv_interp/ir/ops.h"
#include "tests/spirv_interp/atomic_model.h"
#include "tests/spirv_interp/ir_evaluator.h"

namespace vernier::test {
namespace {

using ir::Op;

float asFloat(uint64_t bits) {
    return std::bit_cast<float>(static_cast<uint32_t>(bits));
}
uint32_t asBits(double value) {
    return std::bit_cast<uint32_t>(static_cast<float>(value));
}

/// In double and rounded once, as the reference interpreter does it.
uint32_t transcendental(Op op, const std::vector<uint64_t>& v) {
    const double x = asFloat(v[0]), y = v.size() > 1 ? asFloat(v[1]) : 0;
    switch (op) {
        case Op::fsin:
            return asBits(std::sin(x));
        case Op::fcos:
            return asBits(std::cos(x));
        case Op::ftan:
            return asBits(std::tan(x));
        case Op::fasin:
            return asBits(std::asin(x));
        case Op::facos:
            return asBits(std::acos(x));
        case Op::fatan:
            return asBits(std::atan(x));
        case Op::fatan2:
            return asBits(std::atan2(x, y));
        case Op::fsinh:
            return asBits(std::sinh(x));
        case Op::fcosh:
            return asBits(std::cosh(x));
        case Op::ftanh:
            return asBits(std::tanh(x));
        case Op::fasinh:
            return asBits(std::asinh(x));
        case Op::facosh:
            return asBits(std::acosh(x));
        case Op::fatanh:
            return asBits(std::atanh(x));
        case Op::fexp:
            return asBits(std::exp(x));
        case Op::fexp2:
            return asBits(std::exp2(x));
        case Op::flog:
            return asBits(std::log(x));
        case Op::flog2:
            return asBits(std::log2(x));
        case Op::fpow:
            return asBits(std::pow(x, y));
        default:
            std::abort();
    }
}

uint32_t halfOf(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    const uint32_t sign = bits >> 16 & 0x8000;
    const double magnitude = std::fabs(static_cast<double>(value));
    if (std::isnan(value)) return sign | 0x7E00;
    if (magnitude >= 65520) return sign | 0x7C00;
    int exponent = 0;
    std::frexp(magnitude, &exponent);
    const int step = std::max(exponent - 11, -24);  // exponent of the last bit
    const double units = std::nearbyint(std::ldexp(magnitude, -step));
    if (units == 0) return sign;
    return sign | (step == -24 ? static_cast<uint32_t>(units)
                               : static_cast<uint32_t>((step + 25) << 10) + static_cast<uint32_t>(units) - 1024);
}

float floatOfHalf(uint32_t half) {
    const int exponent = static_cast<int>(half >> 10 & 31);
    const double mantissa = half & 1023;
    double value = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(mantissa + 1024, exponent - 25);
    if (exponent == 31) value = mantissa == 0 ? HUGE_VAL : std::nan("");
    return static_cast<float>(half & 0x8000 ? -value : value);
}

uint32_t* wordAt(std::vector<std::byte>& buffer, uint64_t offset) {
    return offset % 4 == 0 && offset + 4 <= buffer.size() ? reinterpret_cast<uint32_t*>(buffer.data() + offset)
                                                          : nullptr;
}

/// The bytes of a load or store: how many, by the instruction.
std::span<std::byte> bytesAt(std::vector<std::byte>& buffer, uint64_t offset, const ir::Inst& inst) {
    const uint32_t count = ir::immHigh(inst) == 0 ? 4 : ir::immHigh(inst);
    if (offset % count != 0 || offset + count > buffer.size()) return {};
    return std::span(buffer).subspan(offset, count);
}

}  // namespace

Words compileGlsl(ir::Stage stage, std::string_view source, bool debug, VnGlslTarget target) {
    VnGlslDesc desc{};
    // In the order of ir::Stage.
    constexpr VkShaderStageFlagBits kStages[] = {VK_SHADER_STAGE_VERTEX_BIT,
                                                 VK_SHADER_STAGE_FRAGMENT_BIT,
                                                 VK_SHADER_STAGE_COMPUTE_BIT,
                                                 VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT,
                                                 VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT,
                                                 VK_SHADER_STAGE_GEOMETRY_BIT};
    desc.stage = kStages[static_cast<size_t>(stage)];
    desc.source = source.data();
    desc.sourceLength = source.size();
    desc.debugInfo = debug ? 1 : 0;
    desc.target = target;
    VnGlslOutput* output = nullptr;
    Words words;
    if (vnCompileGlsl(&desc, &output) == VN_GLSL_SUCCESS) {
        words.assign(output->words, output->words + output->wordCount);
    } else {
        ADD_FAILURE() << (output != nullptr ? output->log : "out of memory") << "\n" << source;
    }
    vnFreeGlslOutput(output);
    return words;
}

Words assemble(std::string_view source, uint32_t minor) {
    spvtools::SpirvTools tools(minor == 3 ? SPV_ENV_VULKAN_1_1 : minor == 5 ? SPV_ENV_VULKAN_1_2 : SPV_ENV_VULKAN_1_3);
    tools.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
        ADD_FAILURE() << "line " << at.line << ": " << message;
    });
    Words words;
    EXPECT_TRUE(tools.Assemble(source.data(), source.size(), &words));
    return words;
}

Words optimised(const Words& words) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
    optimizer.RegisterPerformancePasses();
    Words result;
    EXPECT_TRUE(optimizer.Run(words.data(), words.size(), &result));
    return result;
}

bool Machine::run(const ir::Program& program) {
    outputs.assign(program.outputs.size(), 0);
    written.assign(program.outputs.size(), false);
    killed = demoted = false;
    buffers.resize(program.resources.size());
    std::vector<uint64_t> values(program.valueTypes.size(), 0);
    std::vector<uint32_t> local(program.localWords, 0);
    ir::BlockId from = 0, block = 0;
    uint32_t steps = 0;
    for (;;) {
        const ir::Block& code = program.blocks[block];
        size_t edge = 0;
        while (edge < code.predecessors.size() && code.predecessors[edge] != from) ++edge;
        std::vector<std::pair<ir::ValueId, uint64_t>> phis;
        ir::BlockId next = block;
        for (const ir::Inst& inst : code.insts) {
            if (++steps > 1'000'000) return false;
            const std::span<const ir::ValueId> operands = program.operandsOf(inst);
            if (inst.op == Op::phi) {
                phis.emplace_back(inst.result, values[operands[edge]]);
                continue;
            }
            for (const auto& [value, bits] : phis) values[value] = bits;
            phis.clear();
            std::vector<uint64_t> v;
            for (const ir::ValueId operand : operands) v.push_back(values[operand]);
            uint64_t* result = inst.result != ir::kNoValue ? &values[inst.result] : nullptr;
            switch (inst.op) {
                case Op::constant:
                    *result = inst.imm;
                    break;
                case Op::undef:
                    *result = 0;
                    break;
                case Op::input:
                    *result = inputs.at(inst.imm);
                    break;
                case Op::inputIndexed:
                    *result = inputs.at(ir::immLow(inst) + std::min<uint64_t>(v[0], ir::immHigh(inst) - 1));
                    break;
                case Op::storeOutput:
                    outputs[inst.imm] = static_cast<uint32_t>(v[0]);
                    written[inst.imm] = true;
                    break;
                case Op::demote:
                    demoted = true;
                    break;
                case Op::isHelper:
                    *result = demoted ? ir::kTrueBits : 0;
                    break;
                case Op::loadLocal:
                    *result = v[0] < ir::immHigh(inst) ? local[ir::immLow(inst) + v[0]] : 0;
                    break;
                case Op::storeLocal:
                    if (v[0] < ir::immHigh(inst)) local[ir::immLow(inst) + v[0]] = static_cast<uint32_t>(v[1]);
                    break;
                case Op::loadBuffer: {
                    const std::span<std::byte> bytes = bytesAt(buffers[ir::resourceOf(inst)], v[1], inst);
                    *result = 0;
                    if (!bytes.empty()) std::memcpy(result, bytes.data(), bytes.size());
                    break;
                }
                case Op::storeBuffer: {
                    const std::span<std::byte> bytes = bytesAt(buffers[ir::resourceOf(inst)], v[1], inst);
                    if (!bytes.empty() && !demoted) std::memcpy(bytes.data(), &v[2], bytes.size());
                    break;
                }
                case Op::bufferSize:
                    *result = buffers[inst.imm].size();
                    break;
                case Op::atomicBuffer: {
                    uint32_t* word = wordAt(buffers[ir::immLow(inst)], v[1]);
                    *result = word != nullptr ? *word : 0;
                    v.resize(4);
                    if (word != nullptr && !demoted) {
                        *word = atomicResult(static_cast<ir::AtomicOp>(ir::immHigh(inst)), *word,
                                             static_cast<uint32_t>(v[2]), static_cast<uint32_t>(v[3]));
                    }
                    break;
                }
                case Op::image: {
                    const auto texel = image ? image(program.imageOps[inst.imm], v) : std::array<uint32_t, 4>{};
                    for (size_t i = 0; i < 4; ++i) result[i] = texel[i];
                    break;
                }
                case Op::imageStore:
                    if (image && !demoted) image(program.imageOps[inst.imm], v);
                    break;
                // One invocation on its own: all derivatives are 0.
                case Op::ddxFine:
                case Op::ddyFine:
                case Op::ddxCoarse:
                case Op::ddyCoarse:
                    *result = 0;
                    break;
                case Op::interpolateAtCentroid:
                case Op::interpolateAtSample:
                case Op::interpolateAtOffset:
                    *result = inputs.at(inst.imm);
                    break;
                case Op::packHalf:
                    *result = halfOf(asFloat(v[0])) | halfOf(asFloat(v[1])) << 16;
                    break;
                case Op::unpackHalfLow:
                    *result = asBits(floatOfHalf(static_cast<uint32_t>(v[0] & 0xFFFF)));
                    break;
                case Op::unpackHalfHigh:
                    *result = asBits(floatOfHalf(static_cast<uint32_t>(v[0] >> 16 & 0xFFFF)));
                    break;
                case Op::quantizeF16:
                    *result = asBits(floatOfHalf(halfOf(asFloat(v[0]))));
                    break;
                case Op::jump:
                    next = code.successors[0];
                    break;
                case Op::branch:
                    next = code.successors[v[0] != 0 ? 0 : 1];
                    break;
                case Op::switchOn: {
                    next = code.successors[0];
                    for (size_t k = 0; k < code.cases.size(); ++k) {
                        if (static_cast<uint32_t>(code.cases[k]) == v[0]) next = code.successors[k + 1];
                    }
                    break;
                }
                case Op::ret:
                    return true;
                case Op::kill:
                    killed = true;
                    return true;
                default:
                    if (isEvaluated(inst.op)) {
                        const size_t typed = inst.op == Op::select ? 1 : 0;
                        *result = evaluateOp(inst.op, inst.type, program.valueTypes[operands[typed]], v, inst.imm);
                    } else {
                        *result = transcendental(inst.op, v);
                    }
                    break;
            }
        }
        from = block;
        block = next;
    }
}

}  // namespace vernier::test
