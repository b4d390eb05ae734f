#include "conformance/hardcases/run.h"

#include "conformance/drivers/try.h"
#include "conformance/tool/rendering.h"

#include <fstream>
#include <system_error>

namespace vernier::conformance::hardcases {
namespace {

std::filesystem::path failureFile(const std::filesystem::path& folder, const std::string& name) {
    return folder / (name + ".failure");
}

std::string sceneFile(size_t index) {
    return std::to_string(index);
}

}  // namespace

SceneOutcome drawScene(Driver& driver, const Scene& scene) {
    Result<std::vector<RenderedImage>> images = driver.render(scene, nullptr);
    if (images) return {std::move(images).value(), Outcome::exact, {}};
    const bool lacking = images.error().code == ErrorCode::unsupported;
    return {{}, lacking ? Outcome::unsupported : Outcome::wrong, images.error().message};
}

Verdict judgeCase(const CaseInput& input, const std::vector<SceneOutcome>& drawn, const Declared& declared) {
    if (!input.status()) return Verdict::wrong("the case itself is broken: " + input.status().error().message);
    Verdict worst;
    for (size_t i = 0; i < input.scenes().size(); ++i) {
        if (i >= drawn.size()) return worst.worse({Outcome::crashed, "not drawn"});
        if (drawn[i].outcome != Outcome::exact) {
            worst = worst.worse({drawn[i].outcome, "scene " + std::to_string(i) + ": " + drawn[i].failure});
        }
    }
    for (const Judge& judge : input.judges()) {
        std::vector<const Drawn*> images;
        for (const size_t scene : judge.scenes) {
            if (drawn[scene].outcome == Outcome::exact) images.push_back(&drawn[scene].images);
        }
        if (images.size() != judge.scenes.size()) continue;
        Verdict verdict = judge.ask(images, declared);
        if (!verdict.witness.empty() && input.scenes().size() > 1) {
            verdict.witness = "scene " + std::to_string(judge.scenes.front()) + ": " + verdict.witness;
        }
        worst = worst.worse(verdict);
    }
    return worst;
}

Status saveOutcome(const SceneOutcome& outcome, const FolderContents& who, size_t index,
                   const std::filesystem::path& folder) {
    Rendering rendering;
    rendering.scene = sceneFile(index);
    rendering.driver = who.driver;
    rendering.version = who.version;
    rendering.limits = std::to_string(who.declared.subPixelBits);
    rendering.images = outcome.images;
    if (outcome.outcome != Outcome::exact) {
        const std::string text = std::to_string(static_cast<int>(outcome.outcome)) + " " + outcome.failure;
        VERNIER_TRY(writeFile(failureFile(folder, rendering.scene), text.data(), text.size()));
    }
    return saveRendering(rendering, folder);
}

Status drawToFolder(Driver& driver, std::span<const HardCase* const> cases, size_t first,
                    const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return invalidArgument("cannot create " + folder.string() + ": " + error.message());
    FolderContents who;
    who.driver = driver.name();
    who.version = driver.version();
    who.declared.subPixelBits = static_cast<int>(driver.subPixelBits());
    size_t index = 0;
    for (const HardCase* hardCase : cases) {
        CaseInput input;
        hardCase->build(input);
        if (!input.status()) {
            return invalidArgument(std::string(hardCase->id) + ": " + input.status().error().message);
        }
        for (const Scene& scene : input.scenes()) {
            const size_t at = index++;
            if (at < first) continue;
            VERNIER_TRY(saveOutcome(drawScene(driver, scene), who, at, folder));
        }
    }
    return {};
}

Result<FolderContents> readFolder(const std::filesystem::path& folder) {
    FolderContents contents;
    for (size_t i = 0; std::filesystem::exists(folder / (sceneFile(i) + ".json")); ++i) {
        Result<Rendering> rendering = loadRendering(folder, sceneFile(i));
        if (!rendering) return rendering.error();
        SceneOutcome outcome{std::move(rendering->images), Outcome::exact, {}};
        if (const Result<std::string> failure = readFile(failureFile(folder, sceneFile(i)))) {
            const size_t space = failure->find(' ');
            outcome.outcome = static_cast<Outcome>(std::stoi(*failure));
            outcome.failure = failure->substr(space + 1);
        }
        contents.driver = rendering->driver;
        contents.version = rendering->version;
        contents.declared.subPixelBits = std::stoi(rendering->limits);
        contents.scenes.push_back(std::move(outcome));
    }
    return contents;
}

}  // namespace vernier::conformance::hardcases
