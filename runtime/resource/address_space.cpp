#include "runtime/resource/address_space.h"

#include <algorithm>
#include <iterator>
#include <mutex>

namespace vernier {
namespace {

uint64_t addressOf(const std::byte* data) {
    return reinterpret_cast<uintptr_t>(data);
}

}  // namespace

void AddressSpace::refreshFarthest(size_t first) {
    for (size_t i = first; i < ranges_.size(); ++i) {
        Range& range = ranges_[i];
        const bool before = i != 0 && ranges_[i - 1].farthestEnd > range.end;
        range.farthestBegin = before ? ranges_[i - 1].farthestBegin : range.begin;
        range.farthestEnd = before ? ranges_[i - 1].farthestEnd : range.end;
    }
}

void AddressSpace::add(std::byte* data, uint64_t bytes) {
    const std::unique_lock lock(mutex_);
    const uint64_t begin = addressOf(data);
    const auto behind = std::upper_bound(ranges_.begin(), ranges_.end(), begin,
                                         [](uint64_t address, const Range& range) { return address < range.begin; });
    const auto place = behind - ranges_.begin();
    ranges_.insert(behind, {begin, begin + bytes, 0, 0});
    refreshFarthest(static_cast<size_t>(place));
}

void AddressSpace::remove(const std::byte* data, uint64_t bytes) {
    const std::unique_lock lock(mutex_);
    const uint64_t begin = addressOf(data);
    const auto found = std::find_if(ranges_.begin(), ranges_.end(), [&](const Range& range) {
        return range.begin == begin && range.end == begin + bytes;
    });
    if (found == ranges_.end()) return;
    const auto place = found - ranges_.begin();
    ranges_.erase(found);
    refreshFarthest(static_cast<size_t>(place));
}

AddressRange AddressSpace::find(uint64_t address) const {
    const std::shared_lock lock(mutex_);
    const auto behind = std::upper_bound(ranges_.begin(), ranges_.end(), address,
                                         [](uint64_t wanted, const Range& one) { return wanted < one.begin; });
    if (behind == ranges_.begin()) return {};
    const Range& last = *std::prev(behind);
    if (address >= last.farthestEnd) return {};
    return {reinterpret_cast<std::byte*>(last.farthestBegin), last.farthestBegin,
            last.farthestEnd - last.farthestBegin};
}

AddressResolver AddressSpace::resolver() const {
    return {const_cast<AddressSpace*>(this),
            [](void* self, uint64_t address) { return static_cast<const AddressSpace*>(self)->find(address); }};
}

}  // namespace vernier
