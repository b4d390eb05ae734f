#include "runtime/command/access_set.h"

#include <algorithm>

namespace vernier {
namespace {

/// A set of more ranges than this is merged, and if that does not help, taken for all that lies between.
constexpr size_t kMostRanges = 256;
/// Neighbouring commands name the same ranges again and again: looked for among the latest.
constexpr size_t kLooksBack = 8;

/// The bytes that a view covers, and what lies between its layers and levels.
std::span<const std::byte> bytesOf(const TextureView& view) {
    const std::byte *begin = nullptr, *end = nullptr;
    for (uint32_t n = 0; n < view.levelCount; ++n) {
        const TextureLevel& level = view.levels[n];
        if (level.data == nullptr) continue;
        const uint64_t rows =
            view.block != nullptr ? (level.height + view.block->height - 1) / view.block->height : level.height;
        const uint64_t slices = std::max(level.depth, view.layerCount);
        const uint64_t bytes =
            (slices - 1) * level.slicePitch + (view.samples - 1) * view.samplePitch + rows * level.rowPitch;
        begin = begin == nullptr ? level.data : std::min(begin, level.data);
        end = std::max(end, level.data + bytes);
    }
    return {begin, end};
}

bool isImage(ir::ResourceKind kind) {
    switch (kind) {
        case ir::ResourceKind::combinedImageSampler:
        case ir::ResourceKind::sampledImage:
        case ir::ResourceKind::storageImage:
        case ir::ResourceKind::uniformTexelBuffer:
        case ir::ResourceKind::storageTexelBuffer:
        case ir::ResourceKind::inputAttachment:
            return true;
        default:
            return false;
    }
}

}  // namespace

void AccessSet::add(std::vector<Range>& ranges, const void* begin, uint64_t bytes) {
    if (begin == nullptr || bytes == 0) return;
    const auto first = reinterpret_cast<uintptr_t>(begin);
    const Range added{first, bytes > UINTPTR_MAX - first ? UINTPTR_MAX : first + bytes};
    const size_t looks = std::min(ranges.size(), kLooksBack);
    if (std::any_of(ranges.end() - static_cast<ptrdiff_t>(looks), ranges.end(),
                    [&](const Range& range) { return range.begin <= added.begin && added.end <= range.end; }))
        return;
    ranges.push_back(added);
    if (ranges.size() < kMostRanges) return;
    compact(ranges);
    if (ranges.size() > kMostRanges / 2) ranges = {{ranges.front().begin, ranges.back().end}};
}

/// Sorts, and joins ranges that touch: afterwards their ends are in order, too.
void AccessSet::compact(std::vector<Range>& ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
    size_t kept = 0;
    for (const Range& range : ranges) {
        if (kept > 0 && range.begin <= ranges[kept - 1].end) {
            ranges[kept - 1].end = std::max(ranges[kept - 1].end, range.end);
        } else {
            ranges[kept++] = range;
        }
    }
    ranges.resize(kept);
}

void AccessSet::add(const AccessSet& other) {
    const auto append = [](std::vector<Range>& to, const std::vector<Range>& from) {
        for (const Range& range : from) add(to, reinterpret_cast<const void*>(range.begin), range.end - range.begin);
    };
    append(reads_, other.reads_);
    append(writes_, other.writes_);
}

void AccessSet::clear() {
    reads_.clear();
    writes_.clear();
}

void AccessSet::finish() {
    compact(reads_);
    compact(writes_);
}

bool AccessSet::meet(const std::vector<Range>& a, const std::vector<Range>& b) {
    for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end();) {
        if (x->end <= y->begin) {
            ++x;
        } else if (y->end <= x->begin) {
            ++y;
        } else {
            return true;
        }
    }
    return false;
}

bool AccessSet::conflicts(const AccessSet& a, const AccessSet& b) {
    return meet(a.writes_, b.writes_) || meet(a.writes_, b.reads_) || meet(a.reads_, b.writes_);
}

std::span<std::byte> layersOf(const Image& image, uint32_t mip, uint32_t first, uint32_t count) {
    if (!image.bound() || mip >= image.info().mipLevels) return {};
    const LevelLayout& level = image.level(mip);
    const bool volume = image.info().type == VK_IMAGE_TYPE_3D;
    const uint32_t layers = volume ? level.extent.depth : image.info().arrayLayers;
    if (first >= layers || count == 0) return {};
    count = std::min(count, layers - first);
    if (volume) return {image.address(mip, 0, first), static_cast<size_t>(count * level.slicePitch)};
    return {image.address(mip, first), static_cast<size_t>((count - 1) * image.layerPitch() + level.slicePitch)};
}

void addAccesses(const ir::Program& program, const BoundDescriptors& bound, AccessSet& accesses) {
    const auto add = [&](bool readOnly, const void* begin, uint64_t bytes) {
        if (readOnly) {
            accesses.read(begin, bytes);
        } else {
            accesses.write(begin, bytes);
        }
    };
    for (const ir::Resource& resource : program.resources) {
        const bool image = isImage(resource.kind);
        const bool buffer =
            resource.kind == ir::ResourceKind::uniformBuffer || resource.kind == ir::ResourceKind::storageBuffer;
        if (!image && !buffer) continue;
        const BoundDescriptorRange found = findDescriptors(resource, bound);
        for (uint32_t n = 0; n < found.slots.size(); ++n) {
            if (buffer) {
                const BufferBinding binding = boundBuffer(found, n);
                add(resource.readOnly, binding.data, binding.size);
            } else if (const TextureView* view = found.slots[n].texture.view; view != nullptr) {
                const uint32_t planes = view->planar != nullptr ? view->planar->format->planeCount : 1;
                for (uint32_t p = 0; p < planes; ++p) {
                    const std::span<const std::byte> bytes = bytesOf(p == 0 ? *view : view->planar->planes[p]);
                    add(resource.readOnly, bytes.data(), bytes.size());
                }
            }
        }
    }
}

bool usesAddresses(const ir::Program& program) {
    const auto byAddress = [](const ir::Inst& inst) {
        return inst.op == ir::Op::loadAddress || inst.op == ir::Op::storeAddress || inst.op == ir::Op::atomicAddress;
    };
    return std::any_of(program.blocks.begin(), program.blocks.end(), [&](const ir::Block& block) {
        return std::any_of(block.insts.begin(), block.insts.end(), byAddress);
    });
}

void addAddressAccesses(const ir::Program& program, const AddressSpace& addresses, AccessSet& accesses) {
    addresses.forEach([&](const std::byte* data, uint64_t bytes) {
        if (program.hasSideEffects) {
            accesses.write(data, bytes);
        } else {
            accesses.read(data, bytes);
        }
    });
}

}  // namespace vernier
