// The driver's functions, one per line of entry_points.def, with the types vulkan_core.h gives them.
#pragma once

#include <vulkan/vulkan_core.h>

#include <type_traits>

#include "api/vulkan/window_system.h"

namespace vernier::vulkan {

#define VERNIER_ENTRY_POINT(name) std::remove_pointer_t<PFN_vk##name> name;
#include "api/vulkan/entry_points.def"
#undef VERNIER_ENTRY_POINT

}  // namespace vernier::vulkan
