#include "conformance/oracle/word_writes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace vernier::conformance::exact {
namespace {

bool sameWord(const RunWord& a, const RunWord& b) {
    return a.buffer == b.buffer && a.offset == b.offset && a.kind == b.kind && a.op == b.op;
}

std::vector<RunWord> ofLane(const std::vector<RunWord>& run, uint32_t lane) {
    std::vector<RunWord> result;
    std::ranges::copy_if(run, std::back_inserter(result), [lane](const RunWord& w) { return w.invocation == lane; });
    return result;
}

/// The words of one place in a buffer, in no order.
using Writes = std::vector<const WordWrite*>;

uint32_t readWord(const StoredBuffer& buffer, uint64_t offset) {
    uint32_t word = 0;
    std::memcpy(&word, buffer.bytes.data() + offset, sizeof word);
    return word;
}

/// What a word holds before the draw, as numbers of `kind`.
Result<OpenWord> before(const StoredBuffer& buffer, uint64_t offset, WordKind kind) {
    const auto found = buffer.open.find(offset);
    if (found == buffer.open.end()) return OpenWord{kind, numberOf(kind, readWord(buffer, offset)), 0};
    if (found->second.kind != kind) return unsupported("oracle: an open word of a buffer is seen as another type");
    return found->second;
}

void storeWord(Writes writes, OpenWord& word) {
    std::stable_partition(writes.begin(), writes.end(), [](const WordWrite* w) { return !w->open; });
    bool first = true;
    for (const WordWrite* write : writes) {
        if (first && !write->open) {
            word = {write->kind, write->value, write->flags};
        } else if (write->value != word.value) {
            const double value = write->nominal ? write->value.value : word.value.value;
            word.value = word.value.united(write->value);
            word.value.value = value;
            word.flags |= write->flags | kOracleEdge | (first ? kOracleSnap : kOracleSequence);
        }
        first = false;
    }
}

bool isSum(spv::Op op) {
    return op == spv::OpAtomicIAdd || op == spv::OpAtomicISub || op == spv::OpAtomicIIncrement ||
           op == spv::OpAtomicIDecrement;
}

double differenceOf(const WordWrite& write, double value) {
    // Modulo 2^32 an unsigned operand is the signed one with its bits.
    const double number = value > 0x7fffffff ? value - 0x1p32 : value;
    return write.op == spv::OpAtomicISub || write.op == spv::OpAtomicIDecrement ? -number : number;
}

bool isBitwise(spv::Op op) {
    return op == spv::OpAtomicAnd || op == spv::OpAtomicOr || op == spv::OpAtomicXor;
}

bool isExtreme(spv::Op op) {
    return (op >= spv::OpAtomicSMin && op <= spv::OpAtomicUMax) || op == spv::OpAtomicFMinEXT ||
           op == spv::OpAtomicFMaxEXT;
}

/// One step of a bitwise operation or an extreme, on numbers of the word's kind.
double combined(spv::Op op, WordKind kind, double a, double b) {
    if (isBitwise(op)) {
        const uint32_t x = wordOf(kind, a), y = wordOf(kind, b);
        return numberOf(kind, op == spv::OpAtomicAnd ? x & y : op == spv::OpAtomicOr ? x | y : x ^ y);
    }
    const bool smaller = op == spv::OpAtomicSMin || op == spv::OpAtomicUMin || op == spv::OpAtomicFMinEXT;
    return smaller ? std::min(a, b) : std::max(a, b);
}

Status sumWord(const Writes& writes, OpenWord& word) {
    for (const WordWrite* write : writes) {
        const double a = differenceOf(*write, write->value.low), b = differenceOf(*write, write->value.high);
        double low = std::min(a, b), high = std::max(a, b);
        if (write->open) {
            low = std::min(low, 0.0);
            high = std::max(high, 0.0);
            word.flags |= kOracleEdge | kOracleSnap;
        }
        word.flags |= write->flags;
        const double by = write->nominal ? differenceOf(*write, write->value.value) : 0;
        word.value = {word.value.value + by, word.value.low + low, word.value.high + high};
    }
    const double least = word.kind == WordKind::signedInteger ? -0x1p31 : 0, span = 0x1p32;
    const double turns = std::floor((word.value.value - least) / span) * span;
    word.value = {word.value.value - turns, word.value.low - turns, word.value.high - turns};
    if (word.value.low < least || word.value.high >= least + span)
        return unsupported("oracle: a sum of uncertain fragments that wraps around");
    return {};
}

Status combineWord(const Writes& writes, OpenWord& word) {
    const spv::Op op = writes.front()->op;
    for (const WordWrite* write : writes) {
        const auto with = [&](double a, double b) { return combined(op, word.kind, a, b); };
        const Interval next{with(word.value.value, write->value.value), with(word.value.low, write->value.low),
                            with(word.value.high, write->value.high)};
        // More bits are a larger number only without a sign, and where operands are certain.
        const bool ordered = write->value.isExact() && word.kind != WordKind::signedInteger && op != spv::OpAtomicXor;
        const bool uncertain = write->open || !write->value.isExact() || !word.value.isExact();
        if (isBitwise(op) && uncertain && !ordered)
            return unsupported("oracle: a bitwise operation of uncertain fragments");
        word.flags |= write->flags;
        if (!write->open) {
            word.value = next;
            continue;
        }
        // The operation pulls up or down: without the fragment the other end stays where it was.
        word.flags |= kOracleEdge | kOracleSnap;
        const double nominal = write->nominal ? next.value : word.value.value;
        word.value = word.value.united(next);
        word.value.value = nominal;
    }
    return {};
}

}  // namespace

std::vector<WordWrite> combineWords(std::span<const std::vector<RunWord>> runs, uint32_t lane, const ValueError& error,
                                    OracleFlags flags) {
    const std::vector<RunWord> nominal = ofLane(runs[0], lane);
    std::vector<WordWrite> result;
    for (const RunWord& word : nominal)
        result.push_back({word.buffer, word.offset, word.kind, word.op, word.number, flags, false, true});
    std::vector<bool> varies(result.size());
    for (size_t run = 1; run < runs.size(); ++run) {
        const std::vector<RunWord> others = ofLane(runs[run], lane);
        for (size_t i = 0; i < result.size(); ++i) {
            if (others.size() != nominal.size() || !sameWord(others[i], nominal[i])) {
                result[i].flags |= kOracleUnknown;
                continue;
            }
            const bool rounded = run + 1 == runs.size();
            varies[i] = varies[i] || (!rounded && others[i].number != nominal[i].number);
            result[i].value = result[i].value.united(others[i].number);
        }
    }
    std::vector<WordWrite> last;
    for (size_t i = 0; i < result.size(); ++i) {
        WordWrite& write = result[i];
        if (write.kind == WordKind::floating) {
            write.value = write.value.widened(error.of(write.value.value, varies[i]));
        }
        if (write.op == spv::OpStore) {
            std::erase_if(last, [&](const WordWrite& w) {
                return w.op == spv::OpStore && w.buffer == write.buffer && w.offset == write.offset;
            });
        }
        last.push_back(write);
    }
    return last;
}

Status applyWords(const Scene& scene, const std::vector<WordWrite>& writes, Memory& memory) {
    std::map<std::pair<uint32_t, uint64_t>, Writes> words;
    for (const WordWrite& write : writes) words[{write.buffer, write.offset}].push_back(&write);
    for (const auto& [place, each] : words) {
        const auto [entry, fresh] = memory.buffers.try_emplace(place.first);
        StoredBuffer& buffer = entry->second;
        if (fresh) buffer.bytes = scene.buffers[place.first].data;
        const WordWrite& one = *each.front();
        const bool alike = std::ranges::all_of(each, [&](const WordWrite* w) {
            return w->kind == one.kind && (w->op == one.op || (isSum(w->op) && isSum(one.op)));
        });
        if (!alike) return unsupported("oracle: a word of a buffer that several operations write");
        Result<OpenWord> word = before(buffer, place.second, one.kind);
        if (one.op == spv::OpStore) {
            // What it held before matters only where nothing certain is stored.
            if (!word) word = OpenWord{one.kind, numberOf(one.kind, readWord(buffer, place.second)), kOracleUnknown};
            storeWord(each, *word);
        } else {
            if (!word) return word.error();
            const bool bits = isBitwise(one.op) && one.kind != WordKind::floating;
            if (!isSum(one.op) && !bits && !isExtreme(one.op))
                return unsupported("oracle: an atomic operation whose order matters");
            if (Status s = isSum(one.op) ? sumWord(each, *word) : combineWord(each, *word); !s) return s;
        }
        const uint32_t declared = wordOf(one.kind, word->value.value);
        std::memcpy(buffer.bytes.data() + place.second, &declared, sizeof declared);
        buffer.open.erase(place.second);
        if (!word->value.isExact() || word->flags != 0) buffer.open[place.second] = *word;
    }
    return {};
}

bool isIdempotent(spv::Op op) {
    return op == spv::OpStore || op == spv::OpAtomicAnd || op == spv::OpAtomicOr || isExtreme(op);
}

bool usesAtomicResults(std::span<const uint32_t> module) {
    std::map<uint32_t, uint32_t> uses;  // by result of an atomic instruction
    bool inFunction = false;
    for (const bool counting : {false, true}) {
        for (size_t at = 5; at < module.size();) {
            const uint32_t length = module[at] >> 16, opcode = module[at] & 0xffff;
            if (length == 0 || at + length > module.size()) break;
            inFunction = (inFunction || opcode == spv::OpFunction) && opcode != spv::OpFunctionEnd;
            const bool atomic = (opcode >= spv::OpAtomicExchange && opcode <= spv::OpAtomicXor) ||
                                opcode == spv::OpAtomicFAddEXT || opcode == spv::OpAtomicFMinEXT ||
                                opcode == spv::OpAtomicFMaxEXT;
            if (!counting && atomic && length > 2) uses[module[at + 2]] = 0;
            for (uint32_t i = 1; counting && inFunction && i < length; ++i) {
                const auto found = uses.find(module[at + i]);
                if (found != uses.end() && ++found->second > 1) return true;  // beside the result itself
            }
            at += length;
        }
    }
    return false;
}

}  // namespace vernier::conformance::exact
