// Whether tests run under the Khronos validation layer.
#pragma once

#include <cstdlib>
#include <cstring>

namespace vernier::test {

/// Whether the validation layer stands between: tests of invalid use then have nothing to see.
inline bool validated() {
    const char* const layers = std::getenv("VK_INSTANCE_LAYERS");
    return layers != nullptr && std::strstr(layers, "VK_LAYER_KHRONOS_validation") != nullptr;
}

}  // namespace vernier::test
