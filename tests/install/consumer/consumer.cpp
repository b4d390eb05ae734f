// Asks an installed Vernier what it is and has it clear an image, from C++; exits with 0 if both work.
#include <vernier/vernier.h>
#include <vernier/vernier_glsl.h>

#include <cstdio>

int main() {
    VnDevice device = nullptr;
    VnContext context = nullptr;
    VnDeviceInfo info{};
    VnImageDesc desc{};
    VnImage image{};
    desc.width = desc.height = 1;
    VkClearColorValue white{};
    for (float& component : white.float32) component = 1;
    uint32_t pixel = 0;
    const bool works = vnCreateDevice(nullptr, &device) == VN_SUCCESS && vnGetDeviceInfo(device, &info) == VN_SUCCESS &&
                       vnCreateContext(device, nullptr, &context) == VN_SUCCESS &&
                       vnCreateImage(device, &desc, &image) == VN_SUCCESS &&
                       vnClearImage(context, image, &white) == VN_SUCCESS &&
                       vnReadImage(context, image, nullptr, &pixel, sizeof pixel) == VN_SUCCESS;
    if (works) std::printf("Vernier %s, %u threads: %08x\n", info.version, info.threads, pixel);
    vnDestroyDevice(device);
    return works && pixel == 0xFFFFFFFFu ? 0 : 1;
}
