#include "spirv_interp/batch/own_memory.h"

#include "spirv_interp/ir/ops.h"

namespace vernier::batch {
namespace {

uint32_t wordsOf(const ir::Resource& resource) {
    return ir::isOfRunner(resource.kind) ? (resource.byteSize + 3) / 4 : 0;
}

uint32_t wordsOf(const ir::Program& program) {
    uint32_t words = 0;
    for (const ir::Resource& resource : program.resources) words += wordsOf(resource);
    return words;
}

}  // namespace

OwnMemory::OwnMemory(const ir::Program& program)
    : program_(program), wordCount_(wordsOf(program)), memory_(wordCount_) {}

ResourceBindings OwnMemory::bind(const ResourceBindings& given) {
    if (wordCount_ == 0) return given;
    const auto& resources = program_.resources;
    buffers_.clear();
    bases_.assign(resources.size(), 0);
    counts_.assign(resources.size(), 0);
    uint32_t* words = memory_.get();
    for (size_t r = 0; r < resources.size(); ++r) {
        const ir::ResourceKind kind = resources[r].kind;
        bases_[r] = static_cast<uint32_t>(buffers_.size());
        if (ir::isOfRunner(kind)) {
            counts_[r] = 1;
            buffers_.push_back({reinterpret_cast<std::byte*>(words), wordsOf(resources[r]) * 4});
            words += wordsOf(resources[r]);
            continue;
        }
        if (given.base == nullptr || given.count == nullptr) continue;
        if (!ir::isBuffer(kind)) bases_[r] = given.base[r];
        if (ir::isBuffer(kind) && given.buffers == nullptr) continue;
        counts_[r] = given.count[r];
        if (!ir::isBuffer(kind)) continue;
        const BufferBinding* first = given.buffers + given.base[r];
        buffers_.insert(buffers_.end(), first, first + counts_[r]);
    }
    ResourceBindings bound = given;
    bound.buffers = buffers_.data();
    bound.base = bases_.data();
    bound.count = counts_.data();
    return bound;
}

}  // namespace vernier::batch
