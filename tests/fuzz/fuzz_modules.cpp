// libFuzzer: modules of the corpus, changed instruction by instruction.
#include <algorithm>
#include <cstring>
#include <vector>

#include "tests/fuzz/exercise.h"
#include "tests/fuzz/mutate.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    std::vector<uint32_t> words(size / 4);
    if (!words.empty()) std::memcpy(words.data(), data, words.size() * 4);
    vernier::proof::exercise(words);
    return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    std::vector<uint32_t> words(size / 4);
    if (!words.empty()) std::memcpy(words.data(), data, words.size() * 4);
    std::mt19937 random(seed);
    vernier::proof::mutateModule(words, random);
    const size_t bytes = std::min(words.size() * 4, maxSize / 4 * 4);
    std::memcpy(data, words.data(), bytes);
    return bytes;
}
