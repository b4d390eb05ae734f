// Which operations of the batch code follow each other most often, over the programs of tests/corpus and the procedural
// kernels, weighted by how often they run: superinstructions are chosen by it. A pair is an operation and the one
// behind it that alone takes its result. Every program has the same weight, however long it runs.
//
// op_statistics [rows of each table]
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <sstream>

#include "bench/compute/kernel.h"
#include "tests/proof/corpus.h"

namespace vernier::bench {
namespace {

constexpr size_t kMostBlocks = 4096;

struct Operation {
    std::string name;
    bool takes = false;  // what the operation before it left in the accumulator
    bool gives = false;  // its result to the accumulator alone
};

/// The blocks of a listing in the order of their numbers.
std::vector<std::vector<Operation>> blocksOf(const std::string& listing) {
    std::vector<std::vector<Operation>> blocks;
    std::istringstream lines(listing.substr(listing.find("batch:\n")));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string place, operand;
        Operation operation;
        if (!(words >> place >> operation.name) || place == "batch:") continue;
        if (operation.name == "countBlock") {
            blocks.emplace_back();
            continue;
        }
        for (size_t k = 0; words >> operand; ++k) {
            const bool accumulator = operand == "acc" || operand == "acc,";
            const bool branches = operation.name.starts_with("split") || operation.name == "choose";
            (k == 0 && !branches ? operation.gives : operation.takes) |= accumulator;
        }
        if (!blocks.empty()) blocks.back().push_back(std::move(operation));
    }
    return blocks;
}

/// Shares of all operations that ran, by the names of one, two or three operations in a row.
struct Tally {
    std::array<std::map<std::string, double>, 3> shares;
    size_t programs = 0;

    void add(const std::vector<std::vector<Operation>>& blocks, const std::vector<uint64_t>& runs) {
        double all = 0;
        for (size_t b = 0; b < blocks.size(); ++b) all += static_cast<double>(runs[b] * blocks[b].size());
        if (all == 0) return;
        ++programs;
        for (size_t b = 0; b < blocks.size(); ++b) {
            for (size_t k = 0; k < blocks[b].size(); ++k) {
                std::string names;
                for (size_t length = 0; length < 3 && k + length < blocks[b].size(); ++length) {
                    const Operation& at = blocks[b][k + length];
                    if (length > 0 && (!blocks[b][k + length - 1].gives || !at.takes)) break;
                    names += (length > 0 ? " > " : "") + at.name;
                    shares[length][names] += static_cast<double>(runs[b]) / all;
                }
            }
        }
    }

    void print(size_t rows) const {
        constexpr const char* kTitles[] = {"operations", "pairs", "triples"};
        for (size_t length = 0; length < shares.size(); ++length) {
            std::vector<std::pair<double, std::string>> sorted;
            for (const auto& [names, share] : shares[length]) sorted.emplace_back(share, names);
            std::sort(sorted.rbegin(), sorted.rend());
            if (sorted.size() > rows) sorted.resize(rows);
            std::printf("%s, %% of the operations that run, mean of %zu programs\n", kTitles[length], programs);
            for (const auto& [share, names] : sorted)
                std::printf("%7.2f  %s\n", 100 * share / static_cast<double>(programs), names.c_str());
            std::printf("\n");
        }
    }
};

std::vector<proof::Case> cases() {
    std::vector<proof::Case> cases;
    for (const char* extension : {".vert", ".frag", ".comp"})
        for (const std::string& file : proof::corpusFiles(extension))
            cases.push_back(proof::loadCorpusProgram(file).subject);
    for (const std::string_view kernel : {"noise.glsl", "raymarch.glsl", "uniform.glsl"}) {
        const std::array<std::string_view, 2> files{kernel, "image.frag"};
        const Result<std::string> source = readKernelSource(files);
        if (!source) throw std::runtime_error(source.error().message);
        proof::Case subject;
        subject.name = kernel;
        subject.words = proof::compileGlsl(ir::Stage::fragment, *source);
        subject.world.inputs = {proof::Filling::Kind::ramp, 0, 1};
        cases.push_back(std::move(subject));
    }
    return cases;
}

int main(int argc, char** argv) {
    Tally tally;
    for (const proof::Case& subject : cases()) {
        const proof::Program program = proof::lower(subject);
        std::vector<uint64_t> runs(kMostBlocks);
        const BatchOptions options{.isa = bestIsa(), .blockRuns = runs};
        const proof::Shape all{"all", std::vector<bool>(subject.invocations, true),
                               std::vector<bool>(subject.invocations, true)};
        const proof::Ending ending = proof::runBatch(subject, program.ir, all, options);
        const std::string error = program.error + ending.error;
        if (!error.empty()) throw std::runtime_error(subject.name + ": " + error);
        tally.add(blocksOf((*BatchProgram::compile(program.ir, options))->disassemble()), runs);
    }
    tally.print(argc > 1 ? static_cast<size_t>(std::atoi(argv[1])) : 30);
    return 0;
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    try {
        return vernier::bench::main(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
