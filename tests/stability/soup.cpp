#include "tests/stability/soup.h"

#include <cmath>
#include <cstdio>

namespace vernier::stability {
namespace {

std::string number(float value) {
    if (std::isnan(value)) return "kNan";
    if (std::isinf(value)) return value > 0 ? "kInf" : "-kInf";
    char text[40];
    if (value == std::nearbyint(value) && std::abs(value) < 1000 && !(value == 0 && std::signbit(value))) {
        std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
    } else {
        std::snprintf(text, sizeof text, "%af", static_cast<double>(value));
    }
    return text;
}

}  // namespace

std::string literal(const Soup& soup) {
    std::string text = "Soup{";
    for (const Triangle& triangle : soup) {
        text += text.back() == '{' ? "{{" : ", {{";
        for (size_t i = 0; i < 3; ++i) {
            text += i == 0 ? "{" : ", {";
            for (size_t c = 0; c < 4; ++c) text += (c == 0 ? "" : ", ") + number(triangle[i][c]);
            text += "}";
        }
        text += "}}";
    }
    return text + "}";
}

}  // namespace vernier::stability
