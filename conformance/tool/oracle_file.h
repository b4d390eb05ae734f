// The oracle's images as they travel from the child process that computed them.
#pragma once

#include "base/result.h"
#include "conformance/oracle/oracle.h"

#include <filesystem>
#include <vector>

namespace vernier::conformance {

/// A private, native-endian format: not for keeping.
Status saveOracle(const std::vector<OracleImage>& images, const std::filesystem::path& path);
Result<std::vector<OracleImage>> loadOracle(const std::filesystem::path& path);

}  // namespace vernier::conformance
