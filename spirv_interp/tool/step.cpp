// step: the reference interpreter instruction by instruction.
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>

#include "spirv_interp/tool/reference_run.h"
#include "spirv_interp/tool/tool.h"
#include "spirv_interp/tool/trace.h"

namespace vernier::tool {
namespace {

constexpr const char* kHelp =
    "s [N]      execute N instructions (1) and print them; an empty line does it again\n"
    "l          execute to the next source line\n"
    "b LINE     execute to that source line\n"
    "c          execute to the end\n"
    "p NAME     print the last value that was given a name (or %ID)\n"
    "q          stop printing and asking\n";

/// Prints what is executed, and between instructions does as stdin says.
class Stepper final : public reference::StepObserver {
  public:
    Stepper(const ModuleInput& input, const reference::Module& module, bool all)
        : input_(input), module_(module), free_(all), printing_(true) {}

    void executed(const reference::Step& step) override {
        if (step.line != line_ && step.line != 0) {
            line_ = step.line;
            if (printing_ && !input_.source.empty()) std::printf("%u: %s\n", line_, input_.sourceLine(line_).c_str());
            if (untilNextLine_ || line_ == untilLine_) ask_ = true;
            if (untilNextLine_ || line_ == untilLine_) untilLine_ = untilNextLine_ = 0;
        }
        remember(step);
        if (printing_) std::printf("%s\n", stepText(module_, step).c_str());
        if (free_) return;
        if (count_ > 0 && --count_ == 0) ask_ = true;
        if (ask_) command();
    }
    /// Before the first instruction.
    void begin() {
        if (!free_) command();
    }

  private:
    void remember(const reference::Step& step) {
        // A store gives the variable's name the value.
        const uint32_t id = step.op == spv::OpStore && !step.operands.empty() ? step.operands[0] : step.result;
        if (id == 0 || step.numbers.empty()) return;
        values_[idName(module_, id)] = valueText(step);
        if (step.op == spv::OpLoad) values_[idName(module_, step.operands[0])] = valueText(step);
    }
    void command() {
        for (std::string line; std::getline(std::cin, line);) {
            std::istringstream words(line.empty() ? last_ : line);
            last_ = words.str();
            std::string verb, argument;
            words >> verb >> argument;
            ask_ = false;
            if (verb == "s") {
                count_ = argument.empty() ? 1 : std::strtoul(argument.c_str(), nullptr, 0);
                return;
            }
            if (verb == "l") {
                untilNextLine_ = 1;
                return;
            }
            if (verb == "b") {
                untilLine_ = static_cast<uint32_t>(std::strtoul(argument.c_str(), nullptr, 0));
                return;
            }
            if (verb == "c" || verb == "q") {
                free_ = true;
                printing_ = verb == "c";
                return;
            }
            if (verb == "p") {
                const auto found = values_.find(argument);
                std::printf("%s %s\n", argument.c_str(),
                            found == values_.end() ? "has no value yet" : ("= " + found->second).c_str());
                continue;
            }
            std::fputs(kHelp, stdout);
        }
        free_ = true;  // the end of the commands: the rest runs
    }

    const ModuleInput& input_;
    const reference::Module& module_;
    std::map<std::string, std::string> values_;
    std::string last_ = "s";
    bool free_, printing_, ask_ = false;
    uint64_t count_ = 0;
    uint32_t line_ = 0, untilLine_ = 0, untilNextLine_ = 0;
};

}  // namespace

Result<int> step(const ModuleInput& input, const Invocation& invocation, const StepOptions& options) {
    const auto module = reference::Module::parse(input.words);
    if (!module) return module.error();
    Stepper stepper(input, *module, options.all);
    reference::Options machine;
    machine.stepwise = true;
    machine.observer = &stepper;
    Invocation own = invocation;
    stepper.begin();
    const auto outcome = runReference<float>(input, *module, own, machine);
    if (!outcome) return outcome.error();
    if (outcome->discarded) std::printf("discarded\n");
    std::printf("%llu steps\n", static_cast<unsigned long long>(outcome->steps));
    return 0;
}

}  // namespace vernier::tool
