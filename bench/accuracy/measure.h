// Measures scenes at positions, each in a process of its own, and keeps what is done: a run that was stopped goes on
// where it was.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/accuracy/accuracy_scene.h"
#include "bench/accuracy/figures.h"
#include "bench/accuracy/position.h"
#include "conformance/tool/driver_choice.h"

namespace vernier::bench {

struct MeasuredScene {
    const AccuracyScene* scene = nullptr;
    conformance::OracleImage oracle;
    std::map<std::string, AccuracyFigures> figures;            // by AccuracyPosition::label
    std::map<std::string, conformance::RenderedImage> images;  // of the judged variant, likewise
};

struct AccuracyRun {
    std::vector<AccuracyPosition> positions;
    std::vector<MeasuredScene> scenes;
    std::string machine;
};

struct MeasureOptions {
    conformance::DriverPaths paths;
    std::vector<const AccuracyScene*> scenes;
    std::filesystem::path out;           // figures, images and logs
    std::vector<std::string> positions;  // labels of those to measure beside `standard`; empty: all
    uint32_t rounds = 3;                 // of timing, at least 1: all positions once, then all of them again
    bool fresh = false;                  // measures again what an earlier run has measured
    /// Called before each step: how many are done, of how many, and what comes. A step is a position of a scene, drawn
    /// for its errors or in one round for its time.
    std::function<void(size_t done, size_t all, const std::string& next)> progress;
};

/// A position that fails is kept with its failure; the error is one of the scene, of the oracle or of the folder, or
/// an unknown position.
/// Figures of an earlier run count only when they were made by this very program file; what it has done of a position
/// is not done again.
Result<AccuracyRun> measureAccuracy(const MeasureOptions& options);

/// The figures of all scenes and positions.
std::string runJson(const AccuracyRun& run);
std::string runCsv(const AccuracyRun& run);

}  // namespace vernier::bench
