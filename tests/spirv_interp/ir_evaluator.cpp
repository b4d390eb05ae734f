#include "tests/spirv_interp/ir_evaluator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "spirv_interp/ir/ops.h"

namespace vernier::test {
namespace {

using ir::Op;
using ir::Type;

template <class F>
using BitsOf = std::conditional_t<sizeof(F) == 4, uint32_t, uint64_t>;

template <class F>
F floatOf(uint64_t bits) {
    return std::bit_cast<F>(static_cast<BitsOf<F>>(bits));
}
template <class F>
uint64_t bitsOf(F value) {
    return std::bit_cast<BitsOf<F>>(value);
}
constexpr uint64_t kTrue = 0xFFFFFFFFu;

template <class F>
F minimum(F a, F b) {
    return std::isnan(b) ? a : a < b ? a : b;
}
template <class F>
F maximum(F a, F b) {
    return std::isnan(b) ? a : a > b ? a : b;
}

template <class F>
uint64_t floatOp(Op op, const std::vector<uint64_t>& v) {
    const F a = floatOf<F>(v[0]), b = v.size() > 1 ? floatOf<F>(v[1]) : F{}, c = v.size() > 2 ? floatOf<F>(v[2]) : F{};
    const F one = 1, zero = 0;
    switch (op) {
        case Op::fadd:
            return bitsOf(a + b);
        case Op::fsub:
            return bitsOf(a - b);
        case Op::fmul:
            return bitsOf(a * b);
        case Op::fdiv:
            return bitsOf(a / b);
        case Op::frem:
            return bitsOf(a - b * std::trunc(a / b));
        case Op::fmod:
            return bitsOf(a - b * std::floor(a / b));
        case Op::fneg:
            return bitsOf(-a);
        case Op::ffma:
            return bitsOf(std::fma(a, b, c));
        case Op::fabs:
            return bitsOf(std::fabs(a));
        case Op::fsign:
            return bitsOf(a > 0 ? one : a < 0 ? -one : zero);
        case Op::ffloor:
            return bitsOf(std::floor(a));
        case Op::fceil:
            return bitsOf(std::ceil(a));
        case Op::ftrunc:
            return bitsOf(std::trunc(a));
        case Op::froundEven:
            return bitsOf(std::nearbyint(a));
        case Op::ffract: {
            const F part = a - std::floor(a);
            return bitsOf(part >= one ? std::nextafter(one, zero) : part);
        }
        case Op::fmin:
            return bitsOf(minimum(a, b));
        case Op::fmax:
            return bitsOf(maximum(a, b));
        case Op::fclamp:
            return bitsOf(minimum(maximum(a, b), c));
        case Op::fmix:
            return bitsOf(a * (one - c) + b * c);
        case Op::fstep:
            return bitsOf(b < a ? zero : one);
        case Op::fsmoothstep: {
            const F t = minimum(maximum((c - a) / (b - a), zero), one);
            return bitsOf(t * t * (F{3} - F{2} * t));
        }
        case Op::fsqrt:
            return bitsOf(std::sqrt(a));
        case Op::finverseSqrt:
            return bitsOf(one / std::sqrt(a));
        case Op::fldexp:
            return bitsOf(std::ldexp(a, static_cast<int32_t>(v[1])));
        case Op::ffrexpMantissa: {
            int exponent = 0;
            return bitsOf(std::isfinite(a) ? std::frexp(a, &exponent) : a);
        }
        case Op::ffrexpExponent: {
            int exponent = 0;
            if (std::isfinite(a)) (void)std::frexp(a, &exponent);
            return static_cast<uint32_t>(exponent);
        }
        case Op::foeq:
            return a == b ? kTrue : 0;
        case Op::fone:
            return !std::isunordered(a, b) && a != b ? kTrue : 0;
        case Op::folt:
            return a < b ? kTrue : 0;
        case Op::fole:
            return a <= b ? kTrue : 0;
        case Op::fueq:
            return std::isunordered(a, b) || a == b ? kTrue : 0;
        case Op::fune:
            return std::isunordered(a, b) || a != b ? kTrue : 0;
        case Op::fult:
            return std::isunordered(a, b) || a < b ? kTrue : 0;
        case Op::fule:
            return std::isunordered(a, b) || a <= b ? kTrue : 0;
        case Op::fisnan:
            return std::isnan(a) ? kTrue : 0;
        case Op::fisinf:
            return std::isinf(a) ? kTrue : 0;
        default:
            std::abort();
    }
}

template <class U>
uint64_t integerOp(Op op, const std::vector<uint64_t>& v) {
    using S = std::make_signed_t<U>;
    using WideU = std::conditional_t<sizeof(U) == 8, unsigned __int128, uint64_t>;
    using WideS = std::conditional_t<sizeof(U) == 8, __int128, int64_t>;
    constexpr unsigned kBits = sizeof(U) * 8;
    const U a = static_cast<U>(v[0]), b = v.size() > 1 ? static_cast<U>(v[1]) : 0;
    const S sa = static_cast<S>(a), sb = static_cast<S>(b);
    const auto word = [](auto x) { return static_cast<uint64_t>(static_cast<U>(x)); };
    const unsigned offset = v.size() > 2 ? static_cast<unsigned>(v[v.size() - 2]) : 0;
    const unsigned count = v.size() > 2 ? static_cast<unsigned>(v[v.size() - 1]) : 0;
    switch (op) {
        case Op::iadd:
            return word(a + b);
        case Op::isub:
            return word(a - b);
        case Op::imul:
            return word(static_cast<WideU>(a) * b);
        case Op::smulHigh:
            return word((static_cast<WideS>(sa) * sb) >> kBits);
        case Op::umulHigh:
            return word((static_cast<WideU>(a) * b) >> kBits);
        case Op::sdiv:
            return b == 0 ? 0 : word(static_cast<WideS>(sa) / sb);
        case Op::udiv:
            return b == 0 ? 0 : word(a / b);
        case Op::srem:
            return b == 0 ? 0 : word(static_cast<WideS>(sa) % sb);
        case Op::smod: {
            if (b == 0) return 0;
            const WideS rest = static_cast<WideS>(sa) % sb;
            return word(rest != 0 && (rest < 0) != (sb < 0) ? rest + sb : rest);
        }
        case Op::umod:
            return b == 0 ? 0 : word(a % b);
        case Op::ineg:
            return word(U{0} - a);
        case Op::iabs:
            return word(sa < 0 ? U{0} - a : a);
        case Op::isign:
            return word(sa > 0 ? 1 : sa < 0 ? -1 : 0);
        case Op::smin:
            return word(sa < sb ? sa : sb);
        case Op::smax:
            return word(sa > sb ? sa : sb);
        case Op::umin:
            return word(a < b ? a : b);
        case Op::umax:
            return word(a > b ? a : b);
        case Op::iand:
            return word(a & b);
        case Op::ior:
            return word(a | b);
        case Op::ixor:
            return word(a ^ b);
        case Op::inot:
            return word(~a);
        case Op::shl:
            return word(a << (b % kBits));
        case Op::lshr:
            return word(a >> (b % kBits));
        case Op::ashr:
            return word(sa >> (b % kBits));
        case Op::bitFieldInsert: {
            U result = a;
            for (unsigned k = 0; k < count && k < kBits && offset < kBits && offset + k < kBits; ++k) {
                const U bit = U{1} << (offset + k);
                result = (b >> k & 1) != 0 ? result | bit : result & ~bit;
            }
            return word(result);
        }
        case Op::bitFieldSExtract:
        case Op::bitFieldUExtract: {
            U result = 0;
            unsigned taken = 0;
            for (; taken < count && taken < kBits && offset < kBits && offset + taken < kBits; ++taken) {
                result |= (a >> (offset + taken) & 1) << taken;
            }
            if (op == Op::bitFieldSExtract && taken > 0 && (result >> (taken - 1) & 1) != 0) {
                for (unsigned k = taken; k < kBits; ++k) result |= U{1} << k;
            }
            return word(result);
        }
        case Op::bitReverse: {
            U result = 0;
            for (unsigned k = 0; k < kBits; ++k) result |= (a >> k & 1) << (kBits - 1 - k);
            return word(result);
        }
        case Op::bitCount: {
            unsigned ones = 0;
            for (unsigned k = 0; k < kBits; ++k) ones += a >> k & 1;
            return ones;
        }
        case Op::findILsb:
            for (unsigned k = 0; k < kBits; ++k) {
                if ((a >> k & 1) != 0) return k;
            }
            return word(-1);
        case Op::findSMsb:
        case Op::findUMsb: {
            const U searched = op == Op::findSMsb && sa < 0 ? ~a : a;
            for (unsigned k = kBits; k-- > 0;) {
                if ((searched >> k & 1) != 0) return k;
            }
            return word(-1);
        }
        case Op::addCarry:
            return (static_cast<WideU>(a) + b) >> kBits != 0 ? 1 : 0;
        case Op::subBorrow:
            return a < b ? 1 : 0;
        case Op::ieq:
            return a == b ? kTrue : 0;
        case Op::ine:
            return a != b ? kTrue : 0;
        case Op::slt:
            return sa < sb ? kTrue : 0;
        case Op::sle:
            return sa <= sb ? kTrue : 0;
        case Op::ult:
            return a < b ? kTrue : 0;
        case Op::ule:
            return a <= b ? kTrue : 0;
        default:
            std::abort();
    }
}

template <class I>
uint64_t saturated(long double x) {
    using U = std::make_unsigned_t<I>;
    if (std::isnan(x)) return 0;
    if (x >= static_cast<long double>(std::numeric_limits<I>::max()))
        return static_cast<U>(std::numeric_limits<I>::max());
    if (x <= static_cast<long double>(std::numeric_limits<I>::min()))
        return static_cast<U>(std::numeric_limits<I>::min());
    return static_cast<U>(static_cast<I>(x));
}

/// By the definition: the multiple of the last bit's value that is nearest, or nearest towards zero.
float halfNextTo(double x, bool towardsZero) {
    if (x == 0 || !std::isfinite(x)) return static_cast<float>(x);
    double unit = 0x1p-24;
    while (std::fabs(x) >= unit * 2048) unit *= 2;
    double units = std::floor(std::fabs(x) / unit);
    const double rest = std::fabs(x) / unit - units;
    if (!towardsZero && (rest > 0.5 || (rest == 0.5 && std::fmod(units, 2) == 1))) units += 1;
    const double magnitude = units * unit;
    return static_cast<float>(std::copysign(magnitude > 65504 ? (towardsZero ? 65504 : HUGE_VAL) : magnitude, x));
}

uint64_t conversion(Op op, Type result, Type operand, const std::vector<uint64_t>& v) {
    const uint64_t a = v[0];
    const auto asReal = [&] {
        return operand == Type::f64 ? floatOf<double>(a) : static_cast<double>(floatOf<float>(a));
    };
    switch (op) {
        case Op::ftos:
            return result == Type::i64 ? saturated<int64_t>(asReal()) : saturated<int32_t>(asReal());
        case Op::ftou:
            return result == Type::i64 ? saturated<uint64_t>(asReal()) : saturated<uint32_t>(asReal());
        case Op::stof: {
            const int64_t x = operand == Type::i64 ? static_cast<int64_t>(a) : static_cast<int32_t>(a);
            return result == Type::f64 ? bitsOf(static_cast<double>(x)) : bitsOf(static_cast<float>(x));
        }
        case Op::utof:
            return result == Type::f64 ? bitsOf(static_cast<double>(a)) : bitsOf(static_cast<float>(a));
        case Op::ftof:
            return result == Type::f64 ? bitsOf(asReal()) : bitsOf(static_cast<float>(asReal()));
        case Op::ftoh:
        case Op::ftohZero:
            return bitsOf(halfNextTo(asReal(), op == Op::ftohZero));
        case Op::zext:
            return operand == Type::b1 ? a & 1 : a;
        case Op::sext:
            return result == Type::i64 && operand == Type::i32
                       ? static_cast<uint64_t>(static_cast<int64_t>(static_cast<int32_t>(a)))
                       : a;
        case Op::itrunc:
        case Op::lowWord:
            return a & 0xFFFFFFFFu;
        case Op::highWord:
            return a >> 32;
        case Op::makeWide:
            return a | v[1] << 32;
        default:
            return a;  // bitcast, copy
    }
}

}  // namespace

bool isEvaluated(Op op) {
    if (op >= Op::fsin && op <= Op::fpow) return false;
    return (op >= Op::fadd && op <= Op::highWord) || op == Op::copy;
}

uint64_t evaluateOp(Op op, Type result, Type operand, const std::vector<uint64_t>& a, uint64_t) {
    switch (op) {
        case Op::band:
            return a[0] & a[1];
        case Op::bor:
            return a[0] | a[1];
        case Op::bxor:
            return a[0] ^ a[1];
        case Op::bnot:
            return ~a[0] & kTrue;
        case Op::select:
            return a[0] != 0 ? a[1] : a[2];
        case Op::copy:
            return a[0];
        default:
            break;
    }
    if (op >= Op::ftos && op <= Op::highWord) return conversion(op, result, operand, a);
    if (op >= Op::fadd && op <= Op::ffrexpExponent) {
        return operand == Type::f64 ? floatOp<double>(op, a) : floatOp<float>(op, a);
    }
    if (op >= Op::foeq && op <= Op::fisinf) {
        return operand == Type::f64 ? floatOp<double>(op, a) : floatOp<float>(op, a);
    }
    return operand == Type::i64 ? integerOp<uint64_t>(op, a) : integerOp<uint32_t>(op, a);
}

Evaluation evaluateInvocation(const ir::Program& program, const std::vector<uint32_t>& inputs,
                              const std::vector<uint32_t>& buffer) {
    Evaluation result;
    result.outputs.resize(program.outputs.size());
    std::vector<uint64_t> values(program.valueTypes.size());
    std::vector<uint32_t> local(program.localWords);
    ir::BlockId block = 0;
    size_t edge = 0;
    const auto follow = [&](ir::BlockId from, size_t successor) {
        const auto& successors = program.blocks[from].successors;
        block = successors[successor];
        size_t earlier = 0;
        for (size_t k = 0; k < successor; ++k) earlier += successors[k] == block ? 1 : 0;
        const auto& predecessors = program.blocks[block].predecessors;
        for (edge = 0; predecessors[edge] != from || earlier != 0; ++edge) {
            if (predecessors[edge] == from) --earlier;
        }
    };
    for (;;) {
        const ir::BlockId here = block;
        const ir::Block& code = program.blocks[here];
        std::vector<std::pair<ir::ValueId, uint64_t>> phis;
        for (const ir::Inst& inst : code.insts) {
            if (inst.op == Op::phi) phis.emplace_back(inst.result, values[program.operandsOf(inst)[edge]]);
        }
        for (const auto& [value, bits] : phis) values[value] = bits;
        for (const ir::Inst& inst : code.insts) {
            const auto operands = program.operandsOf(inst);
            const auto at = [&](size_t k) { return values[operands[k]]; };
            switch (inst.op) {
                case Op::phi:
                    continue;
                case Op::constant:
                    values[inst.result] = inst.imm;
                    continue;
                case Op::undef:
                    values[inst.result] = 0;
                    continue;
                case Op::input:
                    values[inst.result] = inputs[inst.imm];
                    continue;
                case Op::storeOutput:
                    result.outputs[inst.imm] = static_cast<uint32_t>(at(0));
                    continue;
                case Op::demote:
                    result.demoted = true;
                    continue;
                case Op::isHelper:
                    values[inst.result] = result.demoted ? kTrue : 0;
                    continue;
                case Op::loadBuffer:
                    values[inst.result] = at(0) == 0 && at(1) / 4 < buffer.size() ? buffer[at(1) / 4] : 0;
                    continue;
                case Op::loadLocal:
                    values[inst.result] = at(0) < ir::immHigh(inst) ? local[ir::immLow(inst) + at(0)] : 0;
                    continue;
                case Op::storeLocal:
                    if (at(0) < ir::immHigh(inst)) local[ir::immLow(inst) + at(0)] = static_cast<uint32_t>(at(1));
                    continue;
                case Op::jump:
                    follow(here, 0);
                    continue;
                case Op::branch:
                    follow(here, at(0) != 0 ? 0 : 1);
                    continue;
                case Op::switchOn: {
                    size_t taken = 0;
                    for (size_t k = 0; k < code.cases.size(); ++k) {
                        if (static_cast<uint32_t>(code.cases[k]) == static_cast<uint32_t>(at(0))) taken = k + 1;
                    }
                    follow(here, taken);
                    continue;
                }
                case Op::ret:
                    return result;
                case Op::kill:
                    result.killed = true;
                    return result;
                default:
                    break;
            }
            std::vector<uint64_t> bits;
            for (size_t k = 0; k < operands.size(); ++k) bits.push_back(at(k));
            const size_t typed = inst.op == Op::select ? 1 : 0;
            values[inst.result] = evaluateOp(inst.op, inst.type, program.valueTypes[operands[typed]], bits, inst.imm);
        }
    }
}

}  // namespace vernier::test
