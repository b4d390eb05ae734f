// Copies, blits and mipmap generation on the oracle's images.
#pragma once

#include "base/result.h"
#include "conformance/oracle/image_store.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <vector>

namespace vernier::conformance::exact {

/// Each level from the one before by a linear blit.
void generateMips(ImageStore& image);

/// Layers of one image may be slices of the other (Vulkan, vkCmdCopyImage).
Status copyImage(const SceneCopyImage& copy, std::vector<ImageStore>& images);

Status blitImage(const SceneBlitImage& blit, const OracleRules& rules, std::vector<ImageStore>& images);

}  // namespace vernier::conformance::exact
