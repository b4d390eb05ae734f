// Running cases: drawing their scenes on a driver, here or in a process of its own, and asking the judges.
#pragma once

#include "conformance/drivers/driver.h"
#include "conformance/hardcases/hard_case.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

/// What a driver made of one scene: its images, or why there are none.
struct SceneOutcome {
    Drawn images;
    Outcome outcome = Outcome::exact;  // exact: drawn; unsupported, wrong (an error it should not give) or crashed
    std::string failure;
};

/// Draws one scene on a driver in this process.
SceneOutcome drawScene(Driver& driver, const Scene& scene);

/// The verdict on a case: the worst of its judges'. Judges whose scenes were not all drawn are not asked; a scene that
/// was not drawn counts by its own outcome.
Verdict judgeCase(const CaseInput& input, const std::vector<SceneOutcome>& drawn, const Declared& declared);

/// Draws the scenes of `cases` on a driver and leaves every image, or the error instead, in `folder`, so that a process
/// that dies leaves what it had drawn. Begins with scene number `first`, counted through all cases.
Status drawToFolder(Driver& driver, std::span<const HardCase* const> cases, size_t first,
                    const std::filesystem::path& folder);

/// What drawToFolder() and saveOutcome() left, case by case and scene by scene. Scenes that it did not come to are
/// missing at the end.
struct FolderContents {
    Declared declared;
    std::string driver, version;
    std::vector<SceneOutcome> scenes;  // through all cases
};
Result<FolderContents> readFolder(const std::filesystem::path& folder);

/// Leaves the outcome of scene `index` in a folder, as `who` drew it.
Status saveOutcome(const SceneOutcome& outcome, const FolderContents& who, size_t index,
                   const std::filesystem::path& folder);

}  // namespace vernier::conformance::hardcases
