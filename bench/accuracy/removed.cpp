#include "bench/accuracy/removed.h"

namespace vernier::bench {
namespace {

constexpr const char* kAlone = "its arithmetic alone, in axis_cost";
constexpr const char* kBuilt = "built into the sampler and measured, in texture_bench";
constexpr const char* kNotBuilt = "not built: judged, not measured";

constexpr RemovedPosition kRemoved[] = {
    {"perspective division", "estimate and a step of Newton", "nothing: 0.14 ns a pixel both", "1.7 of 2^-23",
     "the division is free", kAlone},
    {"level of detail", "exponent and mantissa", "0.03 ns of some 20 a pixel", "11/256 level",
     "one logarithm serves four pixels: 0.1 % of a pixel", kAlone},
    {"filter weights", "8 bits",
     "of a bilinear and a trilinear sample 8 and 7 % with AVX-512, 2 and 4 % with AVX2, -25 and -12 % with SSE4",
     "1.3 codes",
     "slower on one instruction set, and all have the same bits; at most 3 % of a pixel on another, for 100 KB of "
     "code",
     kBuilt},
    {"filter weights", "4, 6 bits", "as with 8 bits", "16 and 4 codes", "takes as long as 8 bits",
     "from the measurement of 8 bits: the instructions are the same"},
    {"blending", "8 bits",
     "0.14 of 0.47 ns a pixel and layer: 9 % of the scene layers, nothing where nothing is blended", "1 code a layer",
     "what the scene would win it would pay with several codes in each pixel; it needs a second path through all blend "
     "equations, tiles and clears",
     kAlone},
    {"depth", "1/w", "nothing", "as reversed D32",
     "interpolation=double is the axis that helps: 72 to 4 misplaced pixels of the scene close_sheets",
     "not built: the two have the same spacing; the axis that helps is measured"},
    {"samples", "fewer than asked for", "what the samples take", "visible in what is read back",
     "the application's choice, no accuracy of a device", kNotBuilt},
    {"shader arithmetic", "double", "nothing: it costs", "none",
     "GLSL's own doubles run exactly; floats as doubles need elementary functions of doubles", kNotBuilt},
};

}  // namespace

std::span<const RemovedPosition> removedPositions() {
    return kRemoved;
}

}  // namespace vernier::bench
