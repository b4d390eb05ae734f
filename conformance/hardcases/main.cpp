// vernier-hardcases: the numeric hard cases on every driver, each in processes of its own, as a table.
#include "conformance/drivers/try.h"
#include "conformance/hardcases/chart.h"
#include "conformance/hardcases/page.h"
#include "conformance/hardcases/run.h"
#include "conformance/hardcases/table.h"
#include "conformance/tool/child_process.h"
#include "conformance/tool/render_scene.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <system_error>

namespace vernier::conformance::hardcases {
namespace {

struct Options {
    DriverPaths paths;
    bool all = false, dial = false;
    std::vector<std::string> groups, cases, drivers;
    std::filesystem::path markdown, chart, json, html, work = "out/hardcases";
    double timeoutSeconds = 300;
    size_t first = 0;  // of the child
};

/// One column to come: a driver at a position of its dial.
struct Run {
    std::string name;
    DriverChoice choice;
    std::string profile;
};

int fail(const Error& error) {
    std::fprintf(stderr, "vernier-hardcases: %s\n", error.message.c_str());
    return 1;
}

Result<std::vector<const HardCase*>> chosenCases(const Options& options) {
    const bool everything = options.all || (options.groups.empty() && options.cases.empty());
    for (const std::string& id : options.cases) {
        if (findCase(id) == nullptr) return invalidArgument("--case: no case is called '" + id + "'");
    }
    std::vector<const HardCase*> chosen;
    for (const CaseGroup& group : caseGroups()) {
        const bool wholeGroup = std::ranges::count(options.groups, std::string(1, group.letter)) != 0;
        for (const HardCase& each : group.cases) {
            if (everything || wholeGroup || std::ranges::count(options.cases, each.id) != 0) chosen.push_back(&each);
        }
    }
    if (chosen.empty()) return invalidArgument("--group: there is no such group of cases");
    return chosen;
}

std::vector<Run> chosenRuns(const Options& options) {
    std::vector<Run> runs;
    for (const DriverChoice& choice : driverChoices(options.paths)) {
        if (!options.drivers.empty() && std::ranges::count(options.drivers, choice.name) == 0) continue;
        if (!choice.present()) {
            std::fprintf(stderr, "skipped %s: %s\n", choice.name.c_str(), choice.absence.c_str());
            continue;
        }
        runs.push_back({choice.name, choice, options.paths.profile});
        if (choice.name != "api" || !options.dial) continue;
        for (const char* profile : {"draft", "fast", "fine", "reference"})
            runs.push_back({choice.name + " " + profile, choice, profile});
    }
    return runs;
}

/// Draws all scenes of one run in children: after one that died, the next goes on behind the scene that killed it.
Result<FolderContents> drawInChildren(const Options& options, const Run& run, std::span<const HardCase* const> cases,
                                      size_t sceneCount) {
    std::string folderName = run.name;
    std::ranges::replace(folderName, ' ', '-');
    const std::filesystem::path folder = options.work / folderName;
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    std::filesystem::create_directories(folder, error);
    if (error) return invalidArgument("cannot create " + folder.string() + ": " + error.message());
    DriverPaths paths = options.paths;
    paths.profile = run.profile;
    FolderContents all;
    for (size_t first = 0; first < sceneCount;) {
        std::vector<std::string> arguments = driverArguments(paths);
        arguments.insert(arguments.end(), {"draw", "--driver", run.choice.name, "--first", std::to_string(first),
                                           "--work", folder.string()});
        for (const HardCase* each : cases) arguments.insert(arguments.end(), {"--case", std::string(each->id)});
        const ChildResult child = runChild(arguments, folder / "log", options.timeoutSeconds);
        Result<FolderContents> contents = readFolder(folder);
        if (!contents) return contents.error();
        all = std::move(contents).value();
        if (child.ok) break;
        first = all.scenes.size();
        if (first >= sceneCount) break;
        const SceneOutcome died{{}, Outcome::crashed, child.failure};
        VERNIER_TRY(saveOutcome(died, all, first, folder));
        all.scenes.push_back(died);
        ++first;
    }
    return all;
}

/// The pictures of a case, in case its page has to show them: of ours of all cases, since another driver may be wrong.
void keepPictures(TableColumn& column, const std::vector<SceneOutcome>& scenes) {
    constexpr size_t kMostPictures = 2;
    const size_t row = column.verdicts.size() - 1;
    if (!column.ours && column.verdicts[row].outcome != Outcome::wrong) return;
    for (const SceneOutcome& scene : scenes) {
        if (scene.images.empty()) continue;
        std::vector<RenderedImage>& kept = column.pictures[row];
        if (kept.size() < kMostPictures) kept.push_back(scene.images[0]);
    }
}

Result<Table> makeTable(const Options& options) {
    const Result<std::vector<const HardCase*>> chosen = chosenCases(options);
    if (!chosen) return chosen.error();
    Table table;
    std::vector<CaseInput> inputs;
    size_t sceneCount = 0;
    for (const HardCase* each : *chosen) {
        if (each->build == nullptr) {
            table.unreachable.push_back(each);
            continue;
        }
        table.rows.push_back(each);
        each->build(inputs.emplace_back());
        if (!inputs.back().status()) {
            return invalidArgument(std::string(each->id) + ": " + inputs.back().status().error().message);
        }
        sceneCount += inputs.back().scenes().size();
    }
    for (const Run& run : chosenRuns(options)) {
        std::fprintf(stderr, "%s: %zu cases, %zu scenes\n", run.name.c_str(), table.rows.size(), sceneCount);
        Result<FolderContents> drawn = drawInChildren(options, run, table.rows, sceneCount);
        if (!drawn) return drawn.error();
        if (run.choice.ours) drawn->declared = vernierDeclares(drawn->declared.subPixelBits, run.profile);
        TableColumn column{run.name,        run.choice.name, drawn->driver + ", " + drawn->version,
                           run.choice.ours, drawn->declared, {}};
        size_t at = 0;
        for (const CaseInput& input : inputs) {
            std::vector<SceneOutcome> scenes;
            for (size_t i = 0; i < input.scenes().size() && at < drawn->scenes.size(); ++i)
                scenes.push_back(std::move(drawn->scenes[at++]));
            column.verdicts.push_back(judgeCase(input, scenes, drawn->declared));
            keepPictures(column, scenes);
        }
        table.columns.push_back(std::move(column));
    }
    return table;
}

int drawHere(const Options& options) {
    const Result<std::vector<const HardCase*>> cases = chosenCases(options);
    if (!cases) return fail(cases.error());
    const std::vector<DriverChoice> choices = driverChoices(options.paths);
    const auto choice = std::ranges::find(choices, options.drivers.at(0), &DriverChoice::name);
    if (choice == choices.end()) return fail(invalidArgument("--driver: no driver of that name"));
    DriverPaths paths = options.paths;
    paths.robustBufferAccess = true;
    Result<std::unique_ptr<Driver>> driver = createDriver(*choice, paths, false);
    if (!driver) return fail(driver.error());
    const Status drawn = drawToFolder(**driver, *cases, options.first, options.work);
    return drawn ? 0 : fail(drawn.error());
}

int run(int argc, char** argv) {
    CLI::App app("Numeric hard cases on Vernier's API, its Vulkan driver, lavapipe and SwiftShader");
    Options options;
    addDriverOptions(app, options.paths);
    app.add_flag("--all", options.all, "All cases (also when none are named)");
    app.add_option("--group", options.groups, "The cases of a group, by its letter");
    app.add_option("--case", options.cases, "One case, by its id");
    app.add_option("--driver", options.drivers, "Only these drivers: api, icd, lavapipe, swiftshader");
    app.add_flag("--dial", options.dial, "Vernier's API at every position of the accuracy dial");
    app.add_option("--markdown", options.markdown, "Write the table to a Markdown file");
    app.add_option("--json", options.json, "Write the table to a JSON file");
    app.add_option("--chart", options.chart, "Write the table to a picture (SVG)");
    app.add_option("--html", options.html, "Write the table to an HTML page, with pictures of what is wrong");
    app.add_option("--work", options.work, "Folder for the drivers' images")->capture_default_str();
    app.add_option("--timeout", options.timeoutSeconds, "Seconds for a driver's process")->capture_default_str();
    CLI::App* draw = app.add_subcommand("draw", "Draw the cases' scenes on one driver in this process");
    draw->fallthrough();
    draw->add_option("--first", options.first, "Number of the scene to begin with");
    CLI11_PARSE(app, argc, argv);
    if (*draw) return drawHere(options);

    const Result<Table> table = makeTable(options);
    if (!table) return fail(table.error());
    std::fputs(tableText(*table).c_str(), stdout);
    const auto write = [](const std::filesystem::path& path, const std::string& text) -> Status {
        return path.empty() ? Status() : writeFile(path, text.data(), text.size());
    };
    if (Status s = write(options.markdown, tableMarkdown(*table)); !s) return fail(s.error());
    if (Status s = write(options.html, options.html.empty() ? std::string() : tablePage(*table)); !s)
        return fail(s.error());
    if (Status s = write(options.chart, tableChart(*table)); !s) return fail(s.error());
    if (Status s = write(options.json, tableJson(*table)); !s) return fail(s.error());
    const bool good = std::ranges::all_of(table->columns, [](const TableColumn& column) {
        const auto counts = column.counts();
        const auto none = [&](Outcome outcome) { return counts[static_cast<size_t>(outcome)] == 0; };
        return !column.ours || (none(Outcome::allowed) && none(Outcome::wrong) && none(Outcome::crashed));
    });
    return good ? 0 : 1;
}

}  // namespace
}  // namespace vernier::conformance::hardcases

int main(int argc, char** argv) {
    return vernier::conformance::hardcases::run(argc, argv);
}
