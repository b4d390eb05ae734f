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
            return convert([&](const S& x, const Type& from, const Type& to) {
                const bool isSigned = i.op == spv::OpConvertSToF;
                // Straight to the float: by way of a double it would be rounded twice.
                if (program_.options.roundToFloat && to.width == 32)
                    return S::ofNumber(Number(fromInteger<float>(x.bits, from.width, isSigned)));
                return S::ofNumber(fromInteger<Number>(x.bits, from.width, isSigned));
            });
        case spv::OpUConvert:
            return convert(
                [](const S& x, const Type&, const Type& to) { return S::ofBits(x.bits & widthMask(to.width)); });
        case spv::OpSConvert:
            return convert([](const S& x, const Type& from, const Type& to) {
                return S::ofBits(static_cast<uint64_t>(asSigned(x.bits, from.width)) & widthMask(to.width));
            });
        case spv::OpFConvert:
            return convert([&](const S& x, const Type&, const Type& to) {
                const bool towardsZero = to.width == 16 && module_.decorationsOf(i.result).towardsZero;
                if (!towardsZero) return x;
                return S::ofNumber(Number(halfToFloat32(doubleToHalf(static_cast<double>(x.number), true))));
            });
        case spv::OpQuantizeToF16:
            return convert([](const S& x, const Type&, const Type&) {
                return S::ofNumber(Number(quantizeToHalf(toFloat32(x.number))));
            });
        // An address is the scalar of a pointer.
        case spv::OpConvertPtrToU:
        case spv::OpConvertUToPtr:
            setResult(i, S::ofBits(bits(i.operand(0)) & widthMask(resultType(i).width)));
            return true;
        case spv::OpBitcast:
            setResult(i, bitcast(i));
            return true;
        default:
            return false;
    }
}

/// Through a row of bytes, the lowest first (SPIR-V specification, OpBitcast).
template <class Number>
Scalars<Number> Machine<Number>::bitcast(const Instruction& i) const {
    const Type& from = module_.scalarType(module_.valueType(i.operand(0)));
    const Type& to = module_.scalarType(resultType(i));
    std::vector<uint8_t> bytes;
    for (const Scalar<Number>& x : data(i.operand(0))) {
        const uint64_t bits = scalarBits(x, from);
        for (uint32_t shift = 0; shift < from.width; shift += 8) bytes.push_back(static_cast<uint8_t>(bits >> shift));
    }
    Scalars<Number> result;
    const size_t step = to.width / 8;
    for (size_t at = 0; at + step <= bytes.size(); at += step) {
        uint64_t bits = 0;
        for (size_t k = 0; k < step; ++k) bits |= uint64_t{bytes[at + k]} << (8 * k);
        result.push_back(bitsScalar<Number>(bits, to));
    }
    return result;
}

template bool Machine<float>::executeConversion(const Instruction&);
template bool Machine<double>::executeConversion(const Instruction&);
template bool Machine<Real>::executeConversion(const Instruction&);

}  // namespace vernier::reference
