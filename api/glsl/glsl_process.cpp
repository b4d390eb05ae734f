#include "api/glsl/glsl_process.h"

#include <glslang/Public/ShaderLang.h>

#include <cstdint>
#include <mutex>

namespace vernier::glsl {
namespace {

// glslang counts its clients too, but each InitializeProcess() makes its global lock anew, even while another
// thread holds it in a compilation. So it is called for the first reference only, and the count is kept here.
// The state is the process's by nature: there is one glslang in it.
struct ProcessCount {
    std::mutex mutex;
    uint32_t references = 0;
};

ProcessCount& processCount() {
    static ProcessCount count;
    return count;
}

}  // namespace

bool retainProcess() {
    ProcessCount& count = processCount();
    const std::lock_guard lock(count.mutex);
    if (count.references == 0 && !glslang::InitializeProcess()) return false;
    ++count.references;
    return true;
}

bool releaseProcess() {
    ProcessCount& count = processCount();
    const std::lock_guard lock(count.mutex);
    if (count.references == 0) return false;
    if (--count.references == 0) glslang::FinalizeProcess();
    return true;
}

}  // namespace vernier::glsl
