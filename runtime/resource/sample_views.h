// Multisampled memory behind a view of an image that has one sample: a view of it for each sample count that was asked
// for.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "runtime/resource/image.h"

namespace vernier {

class SampleViews {
  public:
    /// Of the extent, format and layers of `single`.
    Result<const ImageView*> find(const ImageView& single, uint32_t samples, const HostAllocator& allocator, Isa isa);

  private:
    struct Made {
        explicit Made(Image of) : image(std::move(of)) {}
        Image image;
        std::unique_ptr<Memory> memory;
        ImageView view;
    };
    static Result<std::unique_ptr<Made>> make(const ImageView& single, uint32_t samples, const HostAllocator& allocator,
                                              Isa isa);

    std::mutex mutex_;
    std::vector<std::unique_ptr<Made>> made_;
};

}  // namespace vernier
