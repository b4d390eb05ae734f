// What is measured of one scene at one position: errors against the exact oracle, coverage, and time.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/result.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

namespace vernier::bench {

/// Absolute errors in units of 1/255 of the full range, so that figures of 8-bit and float targets compare.
struct AccuracyFigures {
    std::string failure;         // empty: everything below was measured
    double frame = 0;            // milliseconds of a steady frame of the timed variant: of the fastest round
    std::vector<double> rounds;  // all of them, each in a process of its own
    double worst = 0, mean = 0;
    uint32_t worstX = 0, worstY = 0;
    std::array<double, 4> worstGot{}, worstExact{};
    uint64_t outside = 0;                // pixels outside what the specification permits
    uint64_t judged = 0, undecided = 0;  // pixels that were compared; that the oracle could not decide
    uint64_t misplaced = 0;           // pixels that show another surface than the exact, unsnapped geometry has there
    uint64_t holes = 0, doubles = 0;  // pixels that the mesh covers too seldom, too often
};

/// Errors of the values: pixels whose coverage may legally differ are left out. `exact`: of vertices that are not
/// snapped, for `misplaced`; its undecided pixels are left out.
void judgeImage(const conformance::RenderedImage& image, const conformance::OracleImage& oracle,
                const conformance::OracleImage& exact, AccuracyFigures& figures);

/// Adds the time of one more round.
void addRound(double milliseconds, AccuracyFigures& figures);

/// Holes and doubles of a counted variant that covers every pixel `cover` times.
void countCover(const conformance::RenderedImage& image, uint32_t cover, AccuracyFigures& figures);

/// The signed error of the component that is most wrong, per pixel, row by row, in units of 1/255; 0 where the pixel is
/// not judged.
std::vector<double> signedErrors(const conformance::RenderedImage& image, const conformance::OracleImage& oracle);

nlohmann::json figuresJson(const AccuracyFigures& figures);
/// The error tells what is missing.
Result<AccuracyFigures> figuresFromJson(const nlohmann::json& json);

}  // namespace vernier::bench
