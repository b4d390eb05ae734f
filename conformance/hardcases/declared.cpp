#include "conformance/hardcases/declared.h"

namespace vernier::conformance::hardcases {

OracleRules Declared::rules() const {
    OracleRules rules;
    rules.subPixelBits = subPixelBits;
    return rules;
}

OracleRules Declared::ownRules() const {
    OracleRules result = rules();
    result.vertexFreedom = 0.5;
    result.interpolationError = own->interpolation;
    result.weightBits = 20;
    result.levelSlack = 0x1p-17;
    return result;
}

Declared vernierDeclares(int subPixelBits, std::string_view profile) {
    const bool fast = profile == "draft" || profile == "fast", reference = profile == "reference";
    const bool inDouble = profile == "fine" || reference;  // attributes, and rounded once
    const size_t tier = fast ? 0 : reference ? 3 : inDouble ? 2 : 1;
    return {subPixelBits, OwnBounds{precision::kUsual[tier], precision::kAngles[tier], inDouble ? 0x1p-22 : 2e-6}};
}

}  // namespace vernier::conformance::hardcases
