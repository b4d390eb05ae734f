#include "tests/vulkan/failing_malloc.h"

#include <link.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* memory, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void* memory);
}

namespace vernier::test {

std::atomic<bool> armed{false};
std::atomic<bool> forGood{false};
std::atomic<int64_t> countdown{0};
std::atomic<int64_t> live{0};

namespace {

uintptr_t linkerBegin = 0, linkerEnd = 0;

int findLinker(dl_phdr_info* info, size_t, void*) {
    if (!std::strstr(info->dlpi_name, "ld-linux")) return 0;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const uintptr_t begin = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
        linkerBegin = linkerBegin ? std::min(linkerBegin, begin) : begin;
        linkerEnd = std::max(linkerEnd, begin + info->dlpi_phdr[i].p_memsz);
    }
    return 1;
}

bool isLinker(const void* caller) {
    const auto address = reinterpret_cast<uintptr_t>(caller);
    return address >= linkerBegin && address < linkerEnd;
}

bool mayAllocate() {
    if (!armed.load()) return true;
    const int64_t left = countdown.fetch_sub(1);
    return forGood.load() ? left > 0 : left != 0;
}

void* counted(void* memory) {
    if (memory) ++live;
    return memory;
}

}  // namespace

bool findDynamicLinker() {
    dl_iterate_phdr(findLinker, nullptr);
    return linkerEnd != 0;
}

}  // namespace vernier::test

using namespace vernier::test;

extern "C" {
void* malloc(size_t bytes) {
    if (isLinker(__builtin_return_address(0))) return __libc_malloc(bytes);
    return mayAllocate() ? counted(__libc_malloc(bytes)) : nullptr;
}
void* calloc(size_t count, size_t bytes) {
    if (isLinker(__builtin_return_address(0))) return __libc_calloc(count, bytes);
    return mayAllocate() ? counted(__libc_calloc(count, bytes)) : nullptr;
}
void* realloc(void* memory, size_t bytes) {
    if (isLinker(__builtin_return_address(0))) return __libc_realloc(memory, bytes);
    if (!mayAllocate()) return nullptr;
    void* moved = __libc_realloc(memory, bytes);
    return memory ? moved : counted(moved);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
    return mayAllocate() ? counted(__libc_memalign(alignment, bytes)) : nullptr;
}
void* memalign(size_t alignment, size_t bytes) {
    return aligned_alloc(alignment, bytes);
}
int posix_memalign(void** memory, size_t alignment, size_t bytes) {
    *memory = aligned_alloc(alignment, bytes);
    return *memory ? 0 : ENOMEM;
}
void free(void* memory) {
    if (memory && !isLinker(__builtin_return_address(0))) --live;
    __libc_free(memory);
}
}
