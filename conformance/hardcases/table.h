// The table case by driver, printed, as Markdown and as JSON.
#pragma once

#include "conformance/hardcases/hard_case.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

/// One column: a driver at one position of its dial, and its verdict on every row.
struct TableColumn {
    std::string name;    // e.g. "api", "api draft", "lavapipe"
    std::string driver;  // as on the command line
    std::string device;  // as the implementation names itself, with its version
    bool ours = false;
    Declared declared;
    std::vector<Verdict> verdicts;  // one per row that is reachable, in order
    // By row: the main outputs of the case's first scenes, where some driver is wrong.
    std::map<size_t, std::vector<RenderedImage>> pictures = {};

    std::array<size_t, kOutcomeCount> counts() const;
};

struct Table {
    std::vector<const HardCase*> rows;  // reachable ones
    std::vector<TableColumn> columns;
    std::vector<const HardCase*> unreachable;
};

std::string tableText(const Table& table);
std::string tableMarkdown(const Table& table);
std::string tableJson(const Table& table);

}  // namespace vernier::conformance::hardcases
