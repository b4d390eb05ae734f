// vernier-spirv: looks into shaders: validates, disassembles, prints the IR and its passes, rates and cost, runs and
// steps through invocations, and tells where floats lose their bits.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>

#include "spirv_interp/tool/tool.h"

namespace vernier::tool {
namespace {

int fail(const Error& error) {
    std::fprintf(stderr, "vernier-spirv: %s\n", error.message.c_str());
    return 2;
}

struct Arguments {
    std::string path, stage, entryPoint, description, tier = "standard";
    std::vector<std::string> settings;
    IrOptions ir;
    RunOptions run;
    StepOptions step;
    ProfileOptions profile;
};

using Command = std::function<Result<int>(const ModuleInput&, const Invocation&)>;

/// A command that runs an invocation.
Command alone(const Command& command) {
    return [command](const ModuleInput& input, const Invocation& invocation) -> Result<int> {
        if (const Status status = input.standsAlone(); !status.ok()) return status.error();
        return command(input, invocation);
    };
}

int perform(const Arguments& arguments, const Command& command) {
    const auto input = readModule(arguments.path, arguments.stage, arguments.entryPoint);
    if (!input) return fail(input.error());
    Invocation invocation;
    if (!arguments.description.empty()) {
        if (const Status status = readDescription(arguments.description, invocation); !status.ok()) {
            return fail(status.error());
        }
    }
    for (const std::string& setting : arguments.settings) {
        if (const Status status = applySetting(setting, invocation); !status.ok()) return fail(status.error());
    }
    const auto code = command(*input, invocation);
    return code ? *code : fail(code.error());
}

int parseAndPerform(int argc, char** argv) {
    CLI::App app(
        "Looks into SPIR-V shaders. Files are .spv, or GLSL (.vert, .tesc, .tese, .geom, .frag, .comp; others with "
        "--stage)");
    app.require_subcommand(1);
    Arguments a;
    Command chosen;
    const auto add = [&](const char* name, const char* text, Command command) {
        CLI::App* sub = app.add_subcommand(name, text);
        sub->add_option("file", a.path, "The module")->required();
        sub->add_option("--stage", a.stage, "vertex, control, evaluation, geometry, fragment or compute");
        sub->add_option("--entry", a.entryPoint, "Name of the entry point");
        sub->callback([&chosen, command] { chosen = command; });
        return sub;
    };
    const auto withInputs = [&](CLI::App* sub) {
        sub->add_option(
            "settings", a.settings,
            "NAME=1,2,3 (also locationN, FragCoord...), \"buffer SET.BINDING=f:1,2,3\", \"image "
            "SET.BINDING=WxHxD:f:...\" (f:, i:, u: or zero, four values a texel), push=f:..., groups=4,1,1; "
            "bytes are h: f: d: b: s: i: u: l: or zero:SIZE");
        sub->add_option("--inputs", a.description, "A file of such settings, one a line");
    };
    add("validate", "Whether the module is valid and can be run",
        [](const ModuleInput& m, const Invocation&) { return validate(m); });
    add("disassemble", "The module as text", [](const ModuleInput& m, const Invocation&) { return disassemble(m); });
    CLI::App* ir =
        add("ir", "The IR after all passes", [&](const ModuleInput& m, const Invocation&) { return printIr(m, a.ir); });
    ir->add_flag("--passes", a.ir.passes, "As it came from the module, and after every pass that changes it");
    ir->add_option("--after", a.ir.after, "After this pass only");
    ir->add_flag("--contract", a.ir.contract, "Fuse multiplications and additions");
    add("rates", "How often every value is computed; registers",
        [](const ModuleInput& m, const Invocation&) { return printRates(m); });
    CLI::App* cost = add("cost", "Operations by kind and source line",
                         [&](const ModuleInput& m, const Invocation&) { return printCost(m, a.ir); });
    cost->add_flag("--listing", a.ir.listing, "The batch code too");
    CLI::App* runCommand =
        add("run", "Runs an invocation, or work-groups, and prints the outputs",
            alone([&](const ModuleInput& m, const Invocation& i) { return tool::run(m, i, a.run); }));
    runCommand->add_option("--engine", a.run.engine, "batch, reference or both")
        ->check(CLI::IsMember({"batch", "reference", "both"}))
        ->capture_default_str();
    runCommand->add_option("--tier", a.tier, "Math tier of the batch engine")
        ->check(CLI::IsMember({"fast", "standard", "fine", "reference"}))
        ->capture_default_str();
    withInputs(runCommand);
    CLI::App* stepCommand = add("step", "Steps through an invocation; commands from stdin, h for help",
                                alone([&](const ModuleInput& m, const Invocation& i) { return step(m, i, a.step); }));
    stepCommand->add_flag("--all", a.step.all, "Print every instruction, without asking");
    withInputs(stepCommand);
    CLI::App* profileCommand =
        add("profile", "The instructions at which floats lose most bits",
            alone([&](const ModuleInput& m, const Invocation& i) { return profile(m, i, a.profile); }));
    profileCommand->add_flag("--mpfr", a.profile.mpfr, "Against numbers of 128 bits instead of double");
    profileCommand->add_option("--count", a.profile.count, "Instructions to show")->capture_default_str();
    withInputs(profileCommand);
    CLI11_PARSE(app, argc, argv);
    constexpr std::pair<const char*, MathTier> kTiers[] = {{"fast", MathTier::fast},
                                                           {"standard", MathTier::standard},
                                                           {"fine", MathTier::fine},
                                                           {"reference", MathTier::reference}};
    for (const auto& [name, tier] : kTiers)
        if (a.tier == name) a.run.tier = tier;
    return perform(a, chosen);
}

}  // namespace
}  // namespace vernier::tool

int main(int argc, char** argv) {
    return vernier::tool::parseAndPerform(argc, argv);
}
