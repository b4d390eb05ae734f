// Constants, specialised: every one is worked out when the module is parsed, since array lengths depend on
// them.
#include <bit>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/module_data.h"
#include "spirv_interp/reference/number_ops.h"

namespace vernier::reference {
namespace {

constexpr uint64_t kMaxConstantScalars = uint64_t{1} << 20;

ConstantScalar scalarFromBits(const Type& type, uint64_t bits) {
    bits &= widthMask(type.width);
    switch (type.kind) {
        case TypeKind::floating:
            return {type.width == 64   ? std::bit_cast<double>(bits)
                    : type.width == 16 ? static_cast<double>(halfToFloat32(static_cast<uint32_t>(bits)))
                                       : static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits))),
                    0};
        case TypeKind::integer:
            return {0, bits};
        default:
            fail("type " + name(type.id) + " of a scalar constant");
    }
}

class ConstantParser {
  public:
    ConstantParser(const ModuleData& module, const Instruction& instruction)
        : module_(module), i_(instruction), type_(module.typeOf(instruction.type)) {}

    std::vector<ConstantScalar> run() {
        switch (i_.op) {
            case spv::OpConstantTrue:
                return boolean(true);
            case spv::OpConstantFalse:
                return boolean(false);
            case spv::OpSpecConstantTrue:
                return boolean(specialized().value_or(1) != 0);
            case spv::OpSpecConstantFalse:
                return boolean(specialized().value_or(0) != 0);
            case spv::OpConstant:
                return {scalarFromBits(type_, literal())};
            case spv::OpSpecConstant:
                return {scalarFromBits(type_, specialized().value_or(literal()))};
            case spv::OpConstantNull:
            case spv::OpUndef:
                return std::vector<ConstantScalar>(module_.valueScalars(type_));
            case spv::OpConstantComposite:
            case spv::OpSpecConstantComposite:
                return composite();
            default:
                return expression(enumerant<spv::Op>(i_.operand(0)), i_.operands.subspan(1));
        }
    }

  private:
    std::optional<uint64_t> specialized() const {
        const auto specId = module_.decorationsOf(i_.result).specId;
        if (!specId) return std::nullopt;
        const auto found = module_.specialization.find(*specId);
        if (found == module_.specialization.end()) return std::nullopt;
        return found->second;
    }

    uint64_t literal() const {
        const uint64_t low = i_.operand(0);
        return type_.width == 64 ? low | uint64_t{i_.operand(1)} << 32 : low;
    }

    std::vector<ConstantScalar> boolean(bool value) const {
        if (type_.kind != TypeKind::boolean) fail(name(i_.result) + " is no boolean");
        return {{0, value ? 1u : 0u}};
    }

    std::vector<ConstantScalar> composite() const {
        const uint64_t count = module_.valueScalars(type_);
        std::vector<ConstantScalar> scalars;
        for (const Id id : i_.operands) {
            const auto& part = module_.constant(id).scalars;
            if (scalars.size() + part.size() > count) break;
            scalars.insert(scalars.end(), part.begin(), part.end());
        }
        if (scalars.size() != count) fail("the constituents of " + name(i_.result) + " do not fit its type");
        return scalars;
    }

    static Id argument(std::span<const uint32_t> arguments, size_t index) {
        if (index >= arguments.size()) fail("OpSpecConstantOp has too few operands");
        return arguments[index];
    }

    std::vector<ConstantScalar> expression(spv::Op op, std::span<const uint32_t> arguments) const {
        const Constant& first = module_.constant(argument(arguments, 0));
        const Type& firstType = module_.types[first.type];
        switch (op) {
            case spv::OpCompositeExtract: {
                const auto range = module_.subrange(firstType, arguments.subspan(1));
                const auto begin = first.scalars.begin() + static_cast<ptrdiff_t>(range.first);
                return {begin, begin + static_cast<ptrdiff_t>(range.count)};
            }
            case spv::OpCompositeInsert: {
                const Constant& whole = module_.constant(argument(arguments, 1));
                const auto range = module_.subrange(module_.types[whole.type], arguments.subspan(2));
                if (range.count != first.scalars.size()) fail(name(i_.result) + " inserts a part of another size");
                std::vector<ConstantScalar> scalars = whole.scalars;
                std::copy(first.scalars.begin(), first.scalars.end(),
                          scalars.begin() + static_cast<ptrdiff_t>(range.first));
                return scalars;
            }
            case spv::OpVectorShuffle: {
                std::vector<ConstantScalar> both = first.scalars, scalars;
                const auto& second = module_.constant(argument(arguments, 1)).scalars;
                both.insert(both.end(), second.begin(), second.end());
                for (const uint32_t component : arguments.subspan(2))
                    scalars.push_back(component < both.size() ? both[component] : ConstantScalar{});
                return scalars;
            }
            case spv::OpSelect: {
                const auto& yes = module_.constant(argument(arguments, 1)).scalars;
                const auto& no = module_.constant(argument(arguments, 2)).scalars;
                if (yes.size() != no.size()) fail(name(i_.result) + " selects between values of different sizes");
                std::vector<ConstantScalar> scalars;
                for (size_t k = 0; k < yes.size(); ++k) {
                    const size_t c = first.scalars.size() == 1 ? 0 : k;
                    if (c >= first.scalars.size()) fail(name(i_.result) + " has too short a condition");
                    scalars.push_back(first.scalars[c].bits != 0 ? yes[k] : no[k]);
                }
                return scalars;
            }
            default:
                return componentwise(op, arguments);
        }
    }

    std::vector<ConstantScalar> componentwise(spv::Op op, std::span<const uint32_t> arguments) const {
        const Constant& first = module_.constant(argument(arguments, 0));
        const Type& from = module_.scalarType(module_.types[first.type]);
        const Type& to = module_.scalarType(type_);
        std::vector<ConstantScalar> scalars;
        for (size_t k = 0; k < first.scalars.size(); ++k) {
            const ConstantScalar& x = first.scalars[k];
            switch (op) {
                case spv::OpUConvert:
                    scalars.push_back({0, x.bits & widthMask(to.width)});
                    continue;
                case spv::OpSConvert:
                    scalars.push_back({0, static_cast<uint64_t>(asSigned(x.bits, from.width)) & widthMask(to.width)});
                    continue;
                case spv::OpFConvert:
                    scalars.push_back({to.width == 64   ? x.number
                                       : to.width == 32 ? static_cast<double>(static_cast<float>(x.number))
                                                        : halfToFloat32(doubleToHalf(x.number)),
                                       0});
                    continue;
                case spv::OpQuantizeToF16:
                    scalars.push_back({quantizeToHalf(static_cast<float>(x.number)), 0});
                    continue;
                default:
                    break;
            }
            const uint32_t count = integerOperandCount(op);
            if (count == 0) failUnsupported("OpSpecConstantOp with " + name(op));
            std::array<uint64_t, 4> operands{};
            for (uint32_t a = 0; a < count; ++a) {
                const auto& operand = module_.constant(argument(arguments, a)).scalars;
                // Shift amounts and bit-field positions may be wider or scalar; everything else has the same
                // shape.
                const size_t at = operand.size() == 1 ? 0 : k;
                if (at >= operand.size()) fail(name(i_.result) + " has operands of different sizes");
                operands[a] = operand[at].bits;
            }
            scalars.push_back({0, integerOperation(op, from.width, operands).value_or(0)});
        }
        return scalars;
    }

    const ModuleData& module_;
    const Instruction& i_;
    const Type& type_;
};

}  // namespace

void parseConstant(ModuleData& module, const Instruction& instruction) {
    Constant constant;
    constant.type = module.typeIndex(instruction.type);
    constant.scalars = ConstantParser(module, instruction).run();
    if (constant.scalars.size() != module.valueScalars(module.types[constant.type]))
        fail("constant " + name(instruction.result) + " does not fit its type");
    module.constantScalars += constant.scalars.size();
    if (module.constantScalars > kMaxConstantScalars) failUnsupported("more than a million scalars of constants");
    module.constants.push_back(std::move(constant));
}

}  // namespace vernier::reference
