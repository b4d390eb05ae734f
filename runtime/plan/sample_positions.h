// Sample locations (specification, "Multisampling"), in sixteenths of a pixel from its upper left corner.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/limits.h"

namespace vernier {

struct SamplePosition {
    uint8_t x16, y16;  // 0 .. 15
    float x() const { return static_cast<float>(x16) / 16; }
    float y() const { return static_cast<float>(y16) / 16; }
};

/// The standard ones, and where programmed ones lie on the same grid.
inline constexpr uint32_t kSampleLocationBits = 4;

inline constexpr std::array<SamplePosition, 1> kSamplePositions1{{{8, 8}}};
inline constexpr std::array<SamplePosition, 2> kSamplePositions2{{{12, 12}, {4, 4}}};
inline constexpr std::array<SamplePosition, 4> kSamplePositions4{{{6, 2}, {14, 6}, {2, 10}, {10, 14}}};
inline constexpr std::array<SamplePosition, 8> kSamplePositions8{
    {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}};
inline constexpr std::array<SamplePosition, 16> kSamplePositions16{{{9, 9},
                                                                    {7, 5},
                                                                    {5, 10},
                                                                    {12, 7},
                                                                    {3, 6},
                                                                    {10, 13},
                                                                    {13, 11},
                                                                    {11, 3},
                                                                    {6, 14},
                                                                    {8, 1},
                                                                    {4, 2},
                                                                    {2, 12},
                                                                    {0, 8},
                                                                    {15, 4},
                                                                    {14, 15},
                                                                    {1, 0}}};

/// The standard positions of a sample count.
inline const SamplePosition* samplePositions(uint32_t samples) {
    switch (samples) {
        case 2:
            return kSamplePositions2.data();
        case 4:
            return kSamplePositions4.data();
        case 8:
            return kSamplePositions8.data();
        case 16:
            return kSamplePositions16.data();
        default:
            return kSamplePositions1.data();
    }
}

}  // namespace vernier
