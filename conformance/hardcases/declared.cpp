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
    if (profile == "draft" || profile == "fast") return {subPixelBits, OwnBounds{4096, 0x1p-11, 2e-6}};
    // Attributes are interpolated in double, and rounded once.
    if (profile == "fine") return {subPixelBits, OwnBounds{1, 0x1p-24, 0x1p-22}};
    if (profile == "reference") return {subPixelBits, OwnBounds{0.5001, 0x1p-24, 0x1p-22}};
    return {subPixelBits, OwnBounds{}};
}

}  // namespace vernier::conformance::hardcases
