// GLSL.std.450 functions that take numbers apart: modf, frexp, ldexp, integers, packing; and interpolateAt*.
#include <algorithm>
#include <bit>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

#include <spirv/unified1/GLSL.std.450.h>

namespace vernier::reference {
namespace {

/// -1 when there is none.
uint64_t highestBit(uint64_t bits, uint32_t width) {
    return (bits == 0 ? ~uint64_t{0} : static_cast<uint64_t>(63 - std::countl_zero(bits))) & widthMask(width);
}

struct PackedFormat {
    uint32_t components, width;
    bool isSigned;
    double scale() const { return static_cast<double>((1u << (isSigned ? width - 1 : width)) - 1); }
};

/// round(clamp(x) * scale) of the float32 nearest to x; NaN gives 0 (unsigned) or the lowest value (signed).
uint32_t packNormalized(float value, const PackedFormat& format, bool stepwise) {
    const double low = format.isSigned ? -1.0 : 0.0;
    const double clamped = value > low ? std::min(static_cast<double>(value), 1.0) : low;
    const double product = clamped * format.scale();
    const auto code =
        static_cast<int64_t>(std::nearbyint(stepwise ? static_cast<double>(static_cast<float>(product)) : product));
    return static_cast<uint32_t>(code) & static_cast<uint32_t>(widthMask(format.width));
}

std::optional<PackedFormat> packedFormat(uint32_t function) {
    switch (function) {
        case GLSLstd450PackSnorm4x8:
        case GLSLstd450UnpackSnorm4x8:
            return PackedFormat{4, 8, true};
        case GLSLstd450PackUnorm4x8:
        case GLSLstd450UnpackUnorm4x8:
            return PackedFormat{4, 8, false};
        case GLSLstd450PackSnorm2x16:
        case GLSLstd450UnpackSnorm2x16:
            return PackedFormat{2, 16, true};
        case GLSLstd450PackUnorm2x16:
        case GLSLstd450UnpackUnorm2x16:
            return PackedFormat{2, 16, false};
        default:
            return std::nullopt;
    }
}

}  // namespace

template <class Number>
bool Machine<Number>::glslStructured(const Instruction& i, uint32_t function) {
    using S = Scalar<Number>;
    using std::frexp, std::isinf, std::ldexp, std::signbit, std::trunc;
    const bool toPointer = function == GLSLstd450Modf || function == GLSLstd450Frexp;
    // Two results: as a struct, or the second through a pointer.
    const auto finish = [&](Scalars<Number> first, const Scalars<Number>& second) {
        if (toPointer) {
            store(pointer(i.operand(3)), second);
        } else {
            first.insert(first.end(), second.begin(), second.end());
        }
        setResult(i, std::move(first));
        return true;
    };
    switch (function) {
        case GLSLstd450Modf:
        case GLSLstd450ModfStruct: {
            Scalars<Number> fractions, wholes;
            for (const S& s : data(i.operand(2))) {
                const Number whole = trunc(s.number);
                Number fraction = isinf(s.number) ? Number(0) : Number(s.number - whole);
                // Both parts have the sign of x, also when they are zero.
                if (fraction == Number(0) && signbit(s.number)) fraction = -Number(0);
                fractions.push_back(S::ofNumber(fraction));
                wholes.push_back(S::ofNumber(whole));
            }
            return finish(std::move(fractions), wholes);
        }
        case GLSLstd450Frexp:
        case GLSLstd450FrexpStruct: {
            Scalars<Number> significands, exponents;
            for (const S& s : data(i.operand(2))) {
                using std::isnan;
                int exponent = 0;
                const bool finite = !isinf(s.number) && !isnan(s.number);
                significands.push_back(S::ofNumber(finite ? Number(frexp(s.number, &exponent)) : s.number));
                exponents.push_back(S::ofInt(finite ? exponent : 0));
            }
            return finish(std::move(significands), exponents);
        }
        case GLSLstd450Ldexp: {
            const size_t count = resultCount(i);
            const Scalars<Number>&x = data(i.operand(2), count), &exponents = data(i.operand(3), count);
            const uint32_t width = module_.scalarType(module_.valueType(i.operand(3))).width;
            Scalars<Number> result;
            for (size_t k = 0; k < count; ++k) {
                // Beyond +-100000 every number type has long overflowed or underflowed.
                const int64_t exponent = std::clamp<int64_t>(asSigned(exponents[k].bits, width), -100000, 100000);
                result.push_back(S::ofNumber(Number(ldexp(x[k].number, static_cast<int>(exponent)))));
            }
            setResult(i, std::move(result));
            return true;
        }
        default:
            return false;
    }
}

template <class Number>
bool Machine<Number>::glslInteger(const Instruction& i, uint32_t function) {
    const auto componentwise = [&](size_t operandCount, auto f) {
        const size_t count = resultCount(i);
        const uint32_t width = module_.scalarType(module_.valueType(i.operand(2))).width;
        Scalars<Number> result;
        for (size_t k = 0; k < count; ++k) {
            std::array<uint64_t, 3> x{};
            for (size_t o = 0; o < operandCount; ++o) x[o] = data(i.operand(2 + o), count)[k].bits;
            result.push_back(Scalar<Number>::ofBits(f(x, width) & widthMask(width)));
        }
        setResult(i, std::move(result));
        return true;
    };
    using X = const std::array<uint64_t, 3>&;
    const auto less = [](uint64_t a, uint64_t b, uint32_t width, bool isSigned) {
        return isSigned ? asSigned(a, width) < asSigned(b, width) : a < b;
    };
    const auto minimum = [&](bool isSigned) {
        return componentwise(2, [=](X x, uint32_t w) { return less(x[1], x[0], w, isSigned) ? x[1] : x[0]; });
    };
    const auto maximum = [&](bool isSigned) {
        return componentwise(2, [=](X x, uint32_t w) { return less(x[0], x[1], w, isSigned) ? x[1] : x[0]; });
    };
    const auto clamp = [&](bool isSigned) {
        return componentwise(3, [=](X x, uint32_t w) {
            const uint64_t atLeast = less(x[0], x[1], w, isSigned) ? x[1] : x[0];
            return less(x[2], atLeast, w, isSigned) ? x[2] : atLeast;
        });
    };
    switch (function) {
        case GLSLstd450SAbs:
            return componentwise(1, [](X x, uint32_t w) { return asSigned(x[0], w) < 0 ? uint64_t{0} - x[0] : x[0]; });
        case GLSLstd450SSign:
            return componentwise(1, [](X x, uint32_t w) {
                return x[0] == 0 ? uint64_t{0} : asSigned(x[0], w) < 0 ? ~uint64_t{0} : uint64_t{1};
            });
        case GLSLstd450UMin:
            return minimum(false);
        case GLSLstd450SMin:
            return minimum(true);
        case GLSLstd450UMax:
            return maximum(false);
        case GLSLstd450SMax:
            return maximum(true);
        case GLSLstd450UClamp:
            return clamp(false);
        case GLSLstd450SClamp:
            return clamp(true);
        case GLSLstd450FindILsb:
            return componentwise(1, [](X x, uint32_t) {
                return x[0] == 0 ? ~uint64_t{0} : static_cast<uint64_t>(std::countr_zero(x[0]));
            });
        case GLSLstd450FindUMsb:
            return componentwise(1, [](X x, uint32_t w) { return highestBit(x[0], w); });
        case GLSLstd450FindSMsb:
            // For a negative number the highest 0 bit.
            return componentwise(
                1, [](X x, uint32_t w) { return highestBit(asSigned(x[0], w) < 0 ? ~x[0] & widthMask(w) : x[0], w); });
        default:
            return false;
    }
}

template <class Number>
bool Machine<Number>::glslPacking(const Instruction& i, uint32_t function) {
    using S = Scalar<Number>;
    const auto format = packedFormat(function);
    switch (function) {
        case GLSLstd450PackSnorm4x8:
        case GLSLstd450PackUnorm4x8:
        case GLSLstd450PackSnorm2x16:
        case GLSLstd450PackUnorm2x16: {
            const Scalars<Number>& x = data(i.operand(2), format->components);
            uint32_t packed = 0;
            for (uint32_t c = 0; c < format->components; ++c)
                packed |= packNormalized(toFloat32(x[c].number), *format, program_.options.stepwise)
                          << (c * format->width);
            setResult(i, S::ofBits(packed));
            return true;
        }
        case GLSLstd450UnpackSnorm4x8:
        case GLSLstd450UnpackUnorm4x8:
        case GLSLstd450UnpackSnorm2x16:
        case GLSLstd450UnpackUnorm2x16: {
            const uint64_t packed = bits(i.operand(2));
            Scalars<Number> result;
            for (uint32_t c = 0; c < format->components; ++c) {
                const auto code = static_cast<uint32_t>((packed >> (c * format->width)) & widthMask(format->width));
                auto number = static_cast<int32_t>(code);
                if (format->isSigned && code >> (format->width - 1) != 0) number -= 1 << format->width;
                const Number x = Number(number) / Number(format->scale());
                result.push_back(S::ofNumber(x < Number(-1) ? Number(-1) : x));
            }
            setResult(i, std::move(result));
            return true;
        }
        case GLSLstd450PackHalf2x16: {
            const Scalars<Number>& x = data(i.operand(2), 2);
            setResult(i,
                      S::ofBits(float32ToHalf(toFloat32(x[0].number)) | float32ToHalf(toFloat32(x[1].number)) << 16));
            return true;
        }
        case GLSLstd450UnpackHalf2x16: {
            const auto packed = static_cast<uint32_t>(bits(i.operand(2)));
            setResult(i, {S::ofNumber(Number(halfToFloat32(packed & 0xFFFF))),
                          S::ofNumber(Number(halfToFloat32(packed >> 16)))});
            return true;
        }
        case GLSLstd450PackDouble2x32: {
            const Scalars<Number>& x = data(i.operand(2), 2);
            setResult(i, S::ofNumber(fromFloat64Bits<Number>((x[0].bits & 0xFFFFFFFFu) | x[1].bits << 32)));
            return true;
        }
        case GLSLstd450UnpackDouble2x32: {
            const uint64_t packed = float64Bits(scalar(i.operand(2)).number);
            setResult(i, {S::ofBits(packed & 0xFFFFFFFFu), S::ofBits(packed >> 32)});
            return true;
        }
        default:
            return false;
    }
}

template <class Number>
bool Machine<Number>::glslInterpolate(const Instruction& i, uint32_t function) {
    InterpolationRequest<Number> request;
    request.invocation = invocation_;
    switch (function) {
        case GLSLstd450InterpolateAtCentroid:
            request.place = InterpolationPlace::centroid;
            break;
        case GLSLstd450InterpolateAtSample:
            request.place = InterpolationPlace::sample;
            request.sample = static_cast<int32_t>(signedInteger(i.operand(3)));
            break;
        case GLSLstd450InterpolateAtOffset: {
            request.place = InterpolationPlace::offset;
            const Scalars<Number>& offset = data(i.operand(3), 2);
            request.offset = {offset[0].number, offset[1].number};
            break;
        }
        default:
            return false;
    }
    const Pointer<Number> p = pointer(i.operand(2));
    if (!p.object || !p.object->layout || p.object->layout->output) fail("interpolation of something that is no input");
    Scalars<Number> result = loadScalars(p);
    for (size_t k = 0; k < result.size() && !p.outside; ++k) {
        const InterfaceCell& cell = p.object->layout->cells[p.offset + k];
        if (cell.isBuiltin) continue;
        request.location = cell.location.location;
        if (const auto texel = resources_.interpolateAt(request)) result[k] = (*texel)[cell.component];
    }
    setResult(i, std::move(result));
    return true;
}

#define VERNIER_INSTANTIATE(Number)                                              \
    template bool Machine<Number>::glslStructured(const Instruction&, uint32_t); \
    template bool Machine<Number>::glslInteger(const Instruction&, uint32_t);    \
    template bool Machine<Number>::glslPacking(const Instruction&, uint32_t);    \
    template bool Machine<Number>::glslInterpolate(const Instruction&, uint32_t);
VERNIER_INSTANTIATE(float)
VERNIER_INSTANTIATE(double)
VERNIER_INSTANTIATE(Real)

}  // namespace vernier::reference
