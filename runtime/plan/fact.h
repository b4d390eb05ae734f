// What explain() tells, fact by fact, for people (text) and for programs (JSON).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vernier {

/// Operations of a program that run equally often.
struct RateShare {
    std::string rate;         // "draw", "vertex", "pixel"...
    uint32_t operations = 0;  // of the program
    uint32_t cost = 0;        // in additions
};

/// Something that a draw, dispatch or frame runs or leaves out.
struct Fact {
    bool runs = true;  // or is left out
    std::string what, why;
    std::vector<RateShare> rates;  // of a program: how often its operations run
    uint32_t instructions = 0;     // of a program: per batch of `lanes`
    uint32_t lanes = 0;
    uint64_t count = 0;  // of a frame: how often it happened
};

/// A line each: "runs      what: why", "left out  what: why".
std::string factsText(std::span<const Fact> facts);
/// An array of objects with "runs", "what" and "why"; "rates", "instructions" and "lanes" of programs, "count" of what
/// a frame counts.
std::string factsJson(std::span<const Fact> facts);

}  // namespace vernier
