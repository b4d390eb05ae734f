// Reduction of far angles (Payne and Hanek, "Radian Reduction for Trigonometric Functions", SIGNUM 18(1), 1983): the
// product of a float and 1/(2 pi) modulo 1, in integers, from just those bits of 1/(2 pi) that matter at the float's
// exponent. One lane at a time: only lanes beyond the reach of the functions' own reduction come here.
#pragma once

#include <bit>
#include <cstdint>

namespace vernier::batch {

/// An angle less its nearest multiple of a step. |rest| <= step / 2, with a relative error below 2^-50.
struct FarAngle {
    double rest = 0;
    bool odd = false;  // the multiple
};

/// x / (2 pi) modulo 1 as a fraction of 2^128; too small by less than 2^-104. For finite |x| >= 2^13.
inline unsigned __int128 turnFraction(float x) {
    // 1/(2 pi) behind a word of zeros: 256 bits reach 128 beyond what the largest float's last bit needs.
    constexpr uint64_t kWords[5] = {0, 0x28be60db9391054a, 0x7f09d5f47d4d3770, 0x36d8a5664f10e410, 0x7f9458eaf7aef158};
    const auto bits = std::bit_cast<uint32_t>(x);
    const uint32_t mantissa = (bits & 0x7FFFFFu) | 0x800000u;
    // |x| = mantissa * 2^exponent; what of 1/(2 pi) times 2^exponent is whole turns is left out.
    const int exponent = static_cast<int>(bits >> 23 & 0xFFu) - 150;
    const unsigned first = static_cast<unsigned>(64 + exponent), word = first / 64, shift = first % 64;
    const auto window = [&](unsigned k) {
        return shift == 0 ? kWords[word + k] : kWords[word + k] << shift | kWords[word + k + 1] >> (64 - shift);
    };
    // The product modulo 1: of the high word's product only the low 64 bits stay.
    const unsigned __int128 low = static_cast<unsigned __int128>(window(1)) * mantissa;
    const unsigned __int128 turns = (static_cast<unsigned __int128>(window(0) * mantissa) << 64) + low;
    return bits >> 31 != 0 ? -turns : turns;
}

/// x = n * pi + rest; with `quarter`, x = (n - 1/2) * pi + rest.
inline FarAngle lessHalfTurns(float x, bool quarter) {
    constexpr unsigned __int128 kQuarterTurn = static_cast<unsigned __int128>(1) << 126;
    const unsigned __int128 turns = turnFraction(x) + (quarter ? kQuarterTurn : 0);
    const unsigned __int128 halves = (turns + kQuarterTurn) >> 127;
    const auto rest = static_cast<__int128>(turns - (halves << 127));
    return {static_cast<double>(rest) * 0x1.921fb54442d18p-126, (halves & 1) != 0};
}

/// x = n * pi / 2 + rest.
inline FarAngle lessQuarterTurns(float x) {
    const unsigned __int128 turns = turnFraction(x);
    const unsigned __int128 quarters = (turns + (static_cast<unsigned __int128>(1) << 125)) >> 126;
    const auto rest = static_cast<__int128>(turns - (quarters << 126));
    return {static_cast<double>(rest) * 0x1.921fb54442d18p-126, (quarters & 1) != 0};
}

}  // namespace vernier::batch
