// Conversions between number formats, and reinterpretation of bits.
#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

template <class Number>
bool Machine<Number>::executeConversion(const Instruction& i) {
    using S = Scalar<Number>;
    const auto convert = [&](auto function) {
        const Type& from = module_.scalarType(module_.valueType(i.operand(0)));
        const Type& to = module_.scalarType(resultType(i));
        Scalars<Number> result;
        for (const S& x : data(i.operand(0), resultCount(i))) result.push_back(function(x, from, to));
        setResult(i, std::move(result));
        return true;
    };
    switch (i.op) {
        case spv::OpConvertFToU:
        case spv::OpConvertFToS:
            return convert([&](const S& x, const Type&, const Type& to) {
                return S::ofBits(toInteger(x.number, to.width, i.op == spv::OpConvertFToS));
            });
        case spv::OpConvertSToF:
        case spv::OpConvertUToF:
            return convert([&](const S& x, const Type& from, const Type&) {
                return S::ofNumber(fromInteger<Number>(x.bits, from.width, i.op == spv::OpConvertSToF));
            });
        case spv::OpUConvert:
            return convert(
                [](const S& x, const Type&, const Type& to) { return S::ofBits(x.bits & widthMask(to.width)); });
        case spv::OpSConvert:
            return convert([](const S& x, const Type& from, const Type& to) {
                return S::ofBits(static_cast<uint64_t>(asSigned(x.bits, from.width)) & widthMask(to.width));
            });
        case spv::OpFConvert:
            return convert([](const S& x, const Type&, const Type&) { return x; });
        case spv::OpQuantizeToF16:
            return convert([](const S& x, const Type&, const Type&) {
                return S::ofNumber(Number(halfToFloat32(float32ToHalf(toFloat32(x.number)))));
            });
        case spv::OpBitcast:
            setResult(i, bitcast(i));
            return true;
        default:
            return false;
    }
}

/// Through a row of 32-bit words, the lower half of a 64-bit scalar first (SPIR-V specification, OpBitcast).
template <class Number>
Scalars<Number> Machine<Number>::bitcast(const Instruction& i) const {
    const Type& from = module_.scalarType(module_.valueType(i.operand(0)));
    const Type& to = module_.scalarType(resultType(i));
    std::vector<uint32_t> words;
    for (const Scalar<Number>& x : data(i.operand(0))) {
        const uint64_t bits = from.kind != TypeKind::floating ? x.bits
                              : from.width == 64              ? float64Bits(x.number)
                                                              : float32Bits(x.number);
        words.push_back(static_cast<uint32_t>(bits));
        if (from.width == 64) words.push_back(static_cast<uint32_t>(bits >> 32));
    }
    Scalars<Number> result;
    const size_t step = to.width / 32;
    for (size_t w = 0; w + step <= words.size(); w += step) {
        const uint64_t bits = step == 2 ? words[w] | uint64_t{words[w + 1]} << 32 : words[w];
        if (to.kind != TypeKind::floating)
            result.push_back(Scalar<Number>::ofBits(bits));
        else
            result.push_back(Scalar<Number>::ofNumber(to.width == 64 ? fromFloat64Bits<Number>(bits)
                                                                     : fromFloat32Bits<Number>(bits)));
    }
    return result;
}

template bool Machine<float>::executeConversion(const Instruction&);
template bool Machine<double>::executeConversion(const Instruction&);
template bool Machine<Real>::executeConversion(const Instruction&);

}  // namespace vernier::reference
