#include "conformance/hardcases/table.h"

#include "conformance/hardcases/reasons.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

namespace vernier::conformance::hardcases {
namespace {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '|') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

std::string padded(std::string_view text, size_t width) {
    std::string result(text.substr(0, width));
    result.resize(width, ' ');
    return result;
}

/// What a driver's column says about a claim that was read in its source.
std::string candidateVerdict(const Table& table, size_t row, const Candidate& candidate) {
    const auto column = std::ranges::find(table.columns, candidate.driver, &TableColumn::driver);
    if (column == table.columns.end()) return "not run";
    const Outcome outcome = column->verdicts[row].outcome;
    if (outcome == Outcome::unsupported) return "not run: unsupported";
    return outcome >= candidate.seenAs ? "confirmed" : "struck out: not seen";
}

void writeGroup(std::ostringstream& out, const Table& table, const CaseGroup& group) {
    std::ostringstream rows;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const HardCase& hardCase = *table.rows[i];
        if (hardCase.group() != group.letter) continue;
        rows << "| " << hardCase.id << " | " << escaped(hardCase.title) << " | " << escaped(hardCase.rule) << " *("
             << escaped(hardCase.source) << ")* |";
        for (const TableColumn& column : table.columns) {
            const Outcome outcome = column.verdicts[i].outcome;
            const bool bad = outcome == Outcome::wrong || outcome == Outcome::crashed;
            rows << ' ' << (bad ? "**" : "") << outcomeName(outcome) << (bad ? "**" : "") << " |";
        }
        rows << '\n';
    }
    if (rows.str().empty()) return;
    out << "\n## " << group.letter << ": " << group.title << "\n\n| Case | Input | Rule |";
    for (const TableColumn& column : table.columns) out << ' ' << column.name << " |";
    out << "\n| --- | --- | --- |";
    for (size_t i = 0; i < table.columns.size(); ++i) out << " --- |";
    out << '\n' << rows.str();
}

void writeWitnesses(std::ostringstream& out, const Table& table) {
    out << "\n## Witnesses\n\nThe first wrong answer of each case and driver: where it is, what is there, what is "
           "exact, and "
           "what else counts.\n\n";
    for (size_t i = 0; i < table.rows.size(); ++i) {
        for (const TableColumn& column : table.columns) {
            const Verdict& verdict = column.verdicts[i];
            if (verdict.outcome != Outcome::wrong && verdict.outcome != Outcome::crashed) continue;
            out << "- **" << table.rows[i]->id << " " << column.name << "**: " << escaped(verdict.witness) << '\n';
        }
    }
}

void writeReasons(std::ostringstream& out) {
    out << "\n## Declared, not nearest\n\nWhere Vernier at `standard` gives another answer than the nearest one, and "
           "why that is right. Every such case has its reason here, and no other one; at every position of the dial "
           "no answer is beyond what that position declares: `hardcases_test`.\n\n"
           "| What is not the nearest | Cases | Why |\n| --- | --- | --- |\n";
    for (const DeclaredReason& reason : declaredReasons()) {
        std::string cases;
        for (const std::string_view id : reason.cases) cases += (cases.empty() ? "" : ", ") + std::string(id);
        out << "| " << escaped(reason.what) << " | " << cases << " | " << escaped(reason.why) << " |\n";
    }
}

void writeCandidates(std::ostringstream& out, const Table& table) {
    out << "\n## Candidates\n\nClaims about other drivers that were read in their source and are decided here by "
           "running "
           "them.\n\n| Case | Driver | Claim | |\n| --- | --- | --- | --- |\n";
    for (size_t i = 0; i < table.rows.size(); ++i) {
        for (const Candidate& candidate : table.rows[i]->candidates) {
            out << "| " << table.rows[i]->id << " | " << candidate.driver << " | " << escaped(candidate.claim) << " | "
                << candidateVerdict(table, i, candidate) << " |\n";
        }
    }
}

}  // namespace

std::array<size_t, kOutcomeCount> TableColumn::counts() const {
    std::array<size_t, kOutcomeCount> result{};
    for (const Verdict& verdict : verdicts) ++result[static_cast<size_t>(verdict.outcome)];
    return result;
}

std::string tableText(const Table& table) {
    constexpr size_t kCase = 5, kTitle = 60, kColumn = 14;
    std::ostringstream out;
    out << padded("case", kCase) << padded("input", kTitle + 1);
    for (const TableColumn& column : table.columns) out << padded(column.name, kColumn);
    out << '\n';
    for (size_t i = 0; i < table.rows.size(); ++i) {
        out << padded(table.rows[i]->id, kCase) << padded(table.rows[i]->title, kTitle) << ' ';
        for (const TableColumn& column : table.columns) out << padded(outcomeName(column.verdicts[i].outcome), kColumn);
        out << '\n';
    }
    for (size_t i = 0; i < table.rows.size(); ++i) {
        for (const TableColumn& column : table.columns) {
            const Verdict& verdict = column.verdicts[i];
            if (verdict.witness.empty()) continue;
            out << table.rows[i]->id << ' ' << column.name << ' ' << outcomeName(verdict.outcome) << ": "
                << verdict.witness << '\n';
        }
    }
    for (const HardCase* hardCase : table.unreachable) {
        out << hardCase->id << " not reached: " << hardCase->unreachable << '\n';
    }
    for (const TableColumn& column : table.columns) {
        out << padded(column.name, kColumn);
        const auto counts = column.counts();
        for (size_t i = 0; i < kOutcomeCount; ++i)
            out << "  " << counts[i] << ' ' << outcomeName(static_cast<Outcome>(i));
        out << '\n';
    }
    return out.str();
}

std::string tableMarkdown(const Table& table) {
    std::ostringstream out;
    out << "# Numeric hard cases\n\nWritten by `vernier-hardcases --all --dial --markdown docs/hardcases.md`. Every "
           "case is a "
           "few "
           "small scenes, drawn by each driver in a process of its own and judged by exact arithmetic "
           "(`conformance/oracle`), "
           "never by another driver's picture.\n\n";
    for (size_t i = 0; i < kOutcomeCount; ++i) out << "- " << outcomeText(static_cast<Outcome>(i)) << '\n';
    out << "\n| Driver | Sub-pixel bits |";
    for (size_t i = 0; i < kOutcomeCount; ++i) out << ' ' << outcomeName(static_cast<Outcome>(i)) << " |";
    out << " What it is |\n| --- | --- |";
    for (size_t i = 0; i < kOutcomeCount; ++i) out << " --- |";
    out << " --- |\n";
    for (const TableColumn& column : table.columns) {
        out << "| " << column.name << " | " << column.declared.subPixelBits << " |";
        for (const size_t count : column.counts()) out << ' ' << count << " |";
        out << ' ' << escaped(column.device) << " |\n";
    }
    out << "\n" << table.rows.size() << " cases run, " << table.unreachable.size() << " are not.\n";
    for (const CaseGroup& group : caseGroups()) writeGroup(out, table, group);
    writeReasons(out);
    writeWitnesses(out, table);
    writeCandidates(out, table);
    out << "\n## Not run\n\n| Case | Input | Why |\n| --- | --- | --- |\n";
    for (const HardCase* hardCase : table.unreachable) {
        out << "| " << hardCase->id << " | " << escaped(hardCase->title) << " | " << escaped(hardCase->unreachable)
            << " |\n";
    }
    return out.str();
}

std::string tableJson(const Table& table) {
    nlohmann::ordered_json document;
    for (const TableColumn& column : table.columns) {
        nlohmann::ordered_json counts;
        for (size_t i = 0; i < kOutcomeCount; ++i)
            counts[std::string(outcomeName(static_cast<Outcome>(i)))] = column.counts()[i];
        document["drivers"].push_back({{"name", column.name},
                                       {"device", column.device},
                                       {"ours", column.ours},
                                       {"subPixelBits", column.declared.subPixelBits},
                                       {"counts", counts}});
    }
    for (size_t i = 0; i < table.rows.size(); ++i) {
        const HardCase& hardCase = *table.rows[i];
        nlohmann::ordered_json verdicts;
        for (const TableColumn& column : table.columns) {
            verdicts[column.name] = {{"outcome", outcomeName(column.verdicts[i].outcome)},
                                     {"witness", column.verdicts[i].witness}};
        }
        document["cases"].push_back({{"id", hardCase.id},
                                     {"input", hardCase.title},
                                     {"rule", hardCase.rule},
                                     {"source", hardCase.source},
                                     {"verdicts", verdicts}});
    }
    for (const HardCase* hardCase : table.unreachable) {
        document["unreachable"].push_back(
            {{"id", hardCase->id}, {"input", hardCase->title}, {"why", hardCase->unreachable}});
    }
    return document.dump(2) + "\n";
}

}  // namespace vernier::conformance::hardcases
