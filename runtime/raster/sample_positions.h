// Standard sample locations (specification, "Multisampling"), in sixteenths of a pixel from its upper left
// corner.
#pragma once

#include <array>
#include <cstdint>

namespace vernier {

struct SamplePosition {
    uint8_t x16, y16;
    float x() const { return static_cast<float>(x16) / 16; }
    float y() const { return static_cast<float>(y16) / 16; }
};

inline constexpr std::array<SamplePosition, 1> kSamplePositions1{{{8, 8}}};
inline constexpr std::array<SamplePosition, 2> kSamplePositions2{{{12, 12}, {4, 4}}};
inline constexpr std::array<SamplePosition, 4> kSamplePositions4{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};

inline const SamplePosition* samplePositions(uint32_t samples) {
    return samples == 4 ? kSamplePositions4.data() : samples == 2 ? kSamplePositions2.data() : kSamplePositions1.data();
}

}  // namespace vernier
