// VK_EXT_headless_surface: images are shown to nobody, with the order and the pace that a window would have.
#include "api/vulkan/screen.h"

namespace vernier::vulkan {
namespace {

class HeadlessScreen final : public Screen {
  public:
    Result<std::unique_ptr<Memory>> allocate(VkDeviceSize size) override { return Memory::create({}, size); }
    VkResult show(const Image&, Done done) noexcept override {
        done();
        return VK_SUCCESS;
    }
};

}  // namespace

std::unique_ptr<Screen> makeHeadlessScreen() {
    return std::make_unique<HeadlessScreen>();
}

}  // namespace vernier::vulkan
