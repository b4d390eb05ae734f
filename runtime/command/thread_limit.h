// How many threads a device takes at most (DeviceDesc::threads).
#pragma once

#include <cstdint>

namespace vernier {

inline constexpr uint32_t kMaxThreads = 256;

}  // namespace vernier
