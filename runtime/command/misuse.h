// What draws and dispatches are given that they should not be, in words, for whoever asked to be told: see
// DeviceDesc::misuse. None of it does harm.
#pragma once

#include <string>

#include "runtime/resource/descriptor.h"

namespace vernier {

/// The first resource of the program that nothing is bound for; empty if there is none. Null descriptors are bound.
std::string missingDescriptor(const ir::Program& program, const BoundDescriptors& bound);

}  // namespace vernier
