#include "runtime/plan/fact.h"

#include <cstdio>
#include <string_view>

namespace vernier {
namespace {

/// RFC 8259, section 7.
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            char escape[7];
            std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c));
            out += escape;
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string json(const Fact& fact) {
    std::string out = std::string("{\"runs\": ") + (fact.runs ? "true" : "false") + ", \"what\": " + quoted(fact.what) +
                      ", \"why\": " + quoted(fact.why);
    if (fact.lanes != 0)
        out +=
            ", \"instructions\": " + std::to_string(fact.instructions) + ", \"lanes\": " + std::to_string(fact.lanes);
    if (!fact.rates.empty()) {
        out += ", \"rates\": {";
        for (const RateShare& share : fact.rates)
            out += (&share == fact.rates.data() ? "" : ", ") + quoted(share.rate) +
                   ": {\"operations\": " + std::to_string(share.operations) +
                   ", \"cost\": " + std::to_string(share.cost) + "}";
        out += "}";
    }
    if (fact.count != 0) out += ", \"count\": " + std::to_string(fact.count);
    return out + "}";
}

}  // namespace

std::string factsText(std::span<const Fact> facts) {
    std::string text;
    for (const Fact& fact : facts)
        text += (fact.runs ? "runs      " : "left out  ") + fact.what + ": " + fact.why + "\n";
    return text;
}

std::string factsJson(std::span<const Fact> facts) {
    std::string text = "[";
    for (const Fact& fact : facts) text += (&fact == facts.data() ? "\n  " : ",\n  ") + json(fact);
    return text + "\n]\n";
}

}  // namespace vernier
