// libFuzzer: arbitrary bytes as a module.
#include <cstring>
#include <vector>

#include "tests/fuzz/exercise.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    std::vector<uint32_t> words(size / 4);
    if (!words.empty()) std::memcpy(words.data(), data, words.size() * 4);
    vernier::proof::exercise(words);
    return 0;
}
