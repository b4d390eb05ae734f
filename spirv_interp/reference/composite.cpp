// Taking values apart and putting them together; selection and copies.
#include <algorithm>

#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

template <class Number>
bool Machine<Number>::executeComposite(const Instruction& i) {
    switch (i.op) {
        case spv::OpUndef:
            setResult(i, Scalars<Number>(resultCount(i)));
            return true;
        case spv::OpCompositeConstruct: {
            const size_t count = resultCount(i);
            Scalars<Number> result;
            for (const Id id : i.operands) {
                const Scalars<Number>& part = data(id);
                if (part.size() > count - result.size()) fail("OpCompositeConstruct has too many constituents");
                result.insert(result.end(), part.begin(), part.end());
            }
            setResult(i, std::move(result));
            return true;
        }
        case spv::OpCompositeExtract: {
            const Scalars<Number>& whole = data(i.operand(0));
            const auto range = module_.subrange(module_.valueType(i.operand(0)), i.operands.subspan(1));
            const auto begin = whole.begin() + static_cast<ptrdiff_t>(range.first);
            setResult(i, Scalars<Number>(begin, begin + static_cast<ptrdiff_t>(range.count)));
            return true;
        }
        case spv::OpCompositeInsert: {
            Scalars<Number> whole = data(i.operand(1));
            const auto range = module_.subrange(module_.valueType(i.operand(1)), i.operands.subspan(2));
            const Scalars<Number>& part = data(i.operand(0), range.count);
            std::copy(part.begin(), part.end(), whole.begin() + static_cast<ptrdiff_t>(range.first));
            setResult(i, std::move(whole));
            return true;
        }
        case spv::OpVectorExtractDynamic: {
            const Scalars<Number>& vector = data(i.operand(0));
            const uint64_t component = bits(i.operand(1));
            setResult(i, component < vector.size() ? vector[component] : Scalar<Number>{});
            return true;
        }
        case spv::OpVectorInsertDynamic: {
            Scalars<Number> vector = data(i.operand(0));
            const uint64_t component = bits(i.operand(2));
            if (component < vector.size()) vector[component] = scalar(i.operand(1));
            setResult(i, std::move(vector));
            return true;
        }
        case spv::OpVectorShuffle: {
            Scalars<Number> both = data(i.operand(0)), result;
            const Scalars<Number>& second = data(i.operand(1));
            both.insert(both.end(), second.begin(), second.end());
            for (const uint32_t component : i.operands.subspan(2)) {
                // 0xFFFFFFFF asks for an undefined component.
                if (component != ~0u && component >= both.size()) fail("OpVectorShuffle component out of range");
                result.push_back(component < both.size() ? both[component] : Scalar<Number>{});
            }
            setResult(i, std::move(result));
            return true;
        }
        case spv::OpTranspose: {
            const Type& type = resultType(i);
            if (type.kind != TypeKind::matrix) fail("OpTranspose to type " + name(type.id));
            const size_t columns = type.count, rows = module_.types[type.element].count;
            const Scalars<Number>& m = data(i.operand(0), columns * rows);
            Scalars<Number> result;
            for (size_t c = 0; c < columns; ++c)
                for (size_t r = 0; r < rows; ++r) result.push_back(m[r * columns + c]);
            setResult(i, std::move(result));
            return true;
        }
        // Logically matching types have the same scalars in the same order.
        case spv::OpCopyObject:
        case spv::OpCopyLogical: {
            Value<Number> v;
            if (module_.info(i.operand(0)).kind == IdKind::variable)
                v.pointer = pointer(i.operand(0));
            else
                v = value(i.operand(0));
            setValue(i, std::move(v));
            return true;
        }
        case spv::OpSelect: {
            const Scalars<Number>& condition = data(i.operand(0));
            if (condition.size() == 1) {
                const Id chosen = i.operand(condition[0].bits != 0 ? 1 : 2);
                Value<Number> v;
                if (module_.info(chosen).kind == IdKind::variable)
                    v.pointer = pointer(chosen);
                else
                    v = value(chosen);
                setValue(i, std::move(v));
                return true;
            }
            const Scalars<Number>&yes = data(i.operand(1), condition.size()),
                  &no = data(i.operand(2), condition.size());
            Scalars<Number> result;
            for (size_t k = 0; k < condition.size(); ++k) result.push_back(condition[k].bits != 0 ? yes[k] : no[k]);
            setResult(i, std::move(result));
            return true;
        }
        default:
            return false;
    }
}

template bool Machine<float>::executeComposite(const Instruction&);
template bool Machine<double>::executeComposite(const Instruction&);
template bool Machine<Real>::executeComposite(const Instruction&);

}  // namespace vernier::reference
