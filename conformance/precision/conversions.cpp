// Conversions between formats.
#include "conformance/precision/vector_math.h"
// After the declarations of vector functions.
#include "conformance/precision/formula.h"
#include "conformance/precision/function.h"

namespace vernier::precision {
namespace {

using reference::Real;

constexpr Promises kExact = {{{0, 0}, {0, 0}, {0, 0}, {0, 0}}};

const Row kSame = valueRow([](const double* x) { return x[0]; });
const Row kTruncated = valueRow([](const double* x) { return std::trunc(x[0]); });

struct Conversion {
    const char *name, *glsl;
    Domain domain;
    Word operand, result;
    const Promises& promises;
    bool (*covers)(const double*) = nullptr;
};

bool fitsInt(const double* x) {
    return x[0] > -0x1p31 - 1 && x[0] < 0x1p31;
}
bool fitsUint(const double* x) {
    return x[0] > -1 && x[0] < 0x1p32;
}
bool fitsLong(const double* x) {
    return x[0] >= -0x1p63 && x[0] < 0x1p63;
}
bool fitsUlong(const double* x) {
    return x[0] > -1 && x[0] < 0x1p64;
}

const Conversion kConversions[] = {
    {"int to float", "float(p)", Domain::floats, Word::int32, Word::float32, kRounded},
    {"uint to float", "float(p)", Domain::floats, Word::uint32, Word::float32, kRounded},
    {"float to int", "int(a)", Domain::floats, Word::float32, Word::int32, kExact, fitsInt},
    {"float to uint", "uint(a)", Domain::floats, Word::float32, Word::uint32, kExact, fitsUint},
    {"float to half", "float16_t(a)", Domain::floats, Word::float32, Word::float16, kRounded},
    {"half to float", "float(p)", Domain::codes, Word::float16, Word::float32, kExact},
    {"packHalf2x16", "unpackHalf2x16(packHalf2x16(vec2(0, a))).y", Domain::floats, Word::float32, Word::float16,
     kRounded},
    {"unpackHalf2x16", "unpackHalf2x16(floatBitsToUint(a)).x", Domain::codes, Word::float16, Word::float32, kExact},
    {"int to half", "float16_t(p)", Domain::floats, Word::int32, Word::float16, kRounded},
    {"uint to half", "float16_t(p)", Domain::floats, Word::uint32, Word::float16, kRounded},
    {"half to int", "int(p)", Domain::codes, Word::float16, Word::int32, kExact, fitsInt},
    {"half to uint", "uint(p)", Domain::codes, Word::float16, Word::uint32, kExact, fitsUint},
    {"double to float", "float(p)", Domain::stratified, Word::float64, Word::float32, kRounded},
    {"float to double", "double(a)", Domain::floats, Word::float32, Word::float64, kExact},
    {"double to half", "float16_t(p)", Domain::stratified, Word::float64, Word::float16, kRounded},
    {"half to double", "double(p)", Domain::codes, Word::float16, Word::float64, kExact},
    {"double to int", "int(p)", Domain::stratified, Word::float64, Word::int32, kExact, fitsInt},
    {"double to uint", "uint(p)", Domain::stratified, Word::float64, Word::uint32, kExact, fitsUint},
    {"int to double", "double(p)", Domain::floats, Word::int32, Word::float64, kExact},
    {"uint to double", "double(p)", Domain::floats, Word::uint32, Word::float64, kExact},
    {"double to int64", "int64_t(p)", Domain::stratified, Word::float64, Word::int64, kExact, fitsLong},
    {"double to uint64", "uint64_t(p)", Domain::stratified, Word::float64, Word::uint64, kExact, fitsUlong},
    {"int64 to double", "double(p)", Domain::stratified, Word::int64, Word::float64, kRounded},
    {"uint64 to double", "double(p)", Domain::stratified, Word::uint64, Word::float64, kRounded},
    {"float to int64", "int64_t(a)", Domain::floats, Word::float32, Word::int64, kExact, fitsLong},
    {"float to uint64", "uint64_t(a)", Domain::floats, Word::float32, Word::uint64, kExact, fitsUlong},
    {"int64 to float", "float(p)", Domain::stratified, Word::int64, Word::float32, kRounded},
    {"uint64 to float", "float(p)", Domain::stratified, Word::uint64, Word::float32, kRounded},
};

constexpr bool isIntegerWord(Word word) {
    return word == Word::int32 || word == Word::uint32 || word == Word::int64 || word == Word::uint64;
}

}  // namespace

void addConversions(std::vector<Function>& all) {
    for (const Conversion& row : kConversions) {
        Function f;
        f.name = row.name;
        f.glsl = row.glsl;
        f.domain = row.domain;
        f.operand = row.operand;
        f.result = row.result;
        f.limitText = &row.promises == &kExact ? "exact" : "correctly rounded";
        f.approximate = isIntegerWord(row.result) ? kTruncated : kSame;
        // Integers of 64 bits are rounded on their way to a double.
        if (row.operand == Word::int64 || row.operand == Word::uint64) {
            f.exact = [](const Real* x) { return x[0]; };
            f.cancels = true;
        }
        f.covers = row.covers;
        f.promises = row.promises;
        all.push_back(f);
    }
}

}  // namespace vernier::precision
