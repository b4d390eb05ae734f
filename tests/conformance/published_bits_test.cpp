// The images of all scenes have the bits that published_bits.txt states, whatever compiler built the renderer, on every
// instruction set, with any number of threads, and whatever is left out (scripts/same-bits: in every build). Where an
// image changes for a reason, the file is written again (VERNIER_PUBLISH_BITS=1 in the environment) and its output
// version goes up by one: that version tells users that images are not comparable to earlier ones.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "base/simd.h"
#include "conformance/drivers/api_driver.h"
#include "conformance/scenes/scenes.h"

namespace vernier::conformance {
namespace {

/// FNV-1a, 64 bits (draft-eastlake-fnv): over formats, extents and texels.
class Hash {
  public:
    void add(const void* data, size_t size) {
        for (size_t i = 0; i < size; ++i) {
            value_ ^= static_cast<const unsigned char*>(data)[i];
            value_ *= 0x100000001B3;
        }
    }
    std::string text() const {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
        return digits;
    }

  private:
    uint64_t value_ = 0xCBF29CE484222325;
};

std::string hashOf(const std::vector<RenderedImage>& images) {
    Hash hash;
    for (const RenderedImage& image : images) {
        const uint32_t head[] = {static_cast<uint32_t>(image.format), image.extent.width, image.extent.height};
        hash.add(head, sizeof head);
        hash.add(image.texels.data(), image.texels.size());
    }
    return hash.text();
}

struct Published {
    int version = 0;
    std::map<std::string, std::string> hashes;
};

Published readPublished() {
    Published published;
    std::ifstream file(VERNIER_PUBLISHED_BITS);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name, value;
        words >> name >> value;
        if (name == "version")
            published.version = std::stoi(value);
        else if (!name.empty() && name[0] != '#')
            published.hashes[name] = value;
    }
    return published;
}

void publish(const Published& before, const std::map<std::string, std::string>& hashes) {
    bool changed = false;  // and not only new scenes
    for (const auto& [name, hash] : before.hashes) {
        const auto found = hashes.find(name);
        changed = changed || (found != hashes.end() && found->second != hash);
    }
    std::ofstream file(VERNIER_PUBLISHED_BITS);
    file << "# Hashes of the images of all scenes: see published_bits_test.cpp.\nversion "
         << (changed || before.version == 0 ? before.version + 1 : before.version) << "\n";
    for (const auto& [name, hash] : hashes) file << name << " " << hash << "\n";
}

/// All scenes by name, built once.
const std::map<std::string, Scene>& builtScenes() {
    static const std::map<std::string, Scene> scenes = [] {
        std::map<std::string, Scene> built;
        for (const SceneEntry& entry : allScenes()) {
            auto scene = entry.build();
            EXPECT_TRUE(scene.ok()) << entry.name << ": " << scene.error().message;
            if (scene) built.emplace(entry.name, std::move(scene).value());
        }
        return built;
    }();
    return scenes;
}

/// Hashes of the images of all scenes that the API can draw.
std::map<std::string, std::string> hashesOfAllScenes(const ApiOptions& options) {
    std::map<std::string, std::string> hashes;
    auto driver = ApiDriver::create(options);
    if (!driver) ADD_FAILURE() << driver.error().message;
    if (!driver) return hashes;
    for (const auto& [name, scene] : builtScenes()) {
        const auto images = driver.value()->render(scene, nullptr);
        // What the API cannot say.
        if (!images && images.error().code == ErrorCode::unsupported) continue;
        EXPECT_TRUE(images.ok()) << name << ": " << images.error().message;
        if (images) hashes[name] = hashOf(*images);
    }
    return hashes;
}

TEST(PublishedBits, OfAllScenes) {
    const Published published = readPublished();
    const std::map<std::string, std::string> hashes = hashesOfAllScenes({});
    if (std::getenv("VERNIER_PUBLISH_BITS") != nullptr) return publish(published, hashes);
    ASSERT_GT(published.version, 0) << "cannot read " VERNIER_PUBLISHED_BITS;
    for (const auto& [name, hash] : hashes) {
        const auto found = published.hashes.find(name);
        if (found == published.hashes.end()) {
            ADD_FAILURE() << name << " has no hash yet: run this test with VERNIER_PUBLISH_BITS=1";
        } else {
            EXPECT_EQ(found->second, hash)
                << name << ": its bits have changed; if that is meant, run this test with VERNIER_PUBLISH_BITS=1";
        }
    }
    for (const auto& [name, hash] : published.hashes) EXPECT_TRUE(hashes.contains(name)) << name << " is no scene";
}

/// Holds what was drawn in some other way to the published hashes.
void expectPublished(const ApiOptions& options) {
    const Published published = readPublished();
    const std::map<std::string, std::string> hashes = hashesOfAllScenes(options);
    EXPECT_GT(hashes.size(), 50u);
    for (const auto& [name, hash] : hashes) {
        const auto found = published.hashes.find(name);
        if (found == published.hashes.end()) continue;
        EXPECT_EQ(found->second, hash) << name;
    }
}

// Threads and instruction sets change no bit.
class Machine : public testing::TestWithParam<std::tuple<Isa, uint32_t>> {};

TEST_P(Machine, ChangesNoBit) {
    const auto& [isa, threads] = GetParam();
    ApiOptions options;
    options.maxIsa = isaName(isa).data();
    options.threads = threads;
    expectPublished(options);
}

INSTANTIATE_TEST_SUITE_P(PublishedBits, Machine,
                         testing::Combine(testing::ValuesIn(availableIsas()), testing::Values(1, 2, 5)),
                         [](const auto& test) {
                             return std::string(isaName(std::get<0>(test.param))) + "_with_" +
                                    std::to_string(std::get<1>(test.param));
                         });

// Leaving out what a scene does not need changes no bit: each rule alone, and all of them.
class LeavingOut : public testing::TestWithParam<const char*> {};

TEST_P(LeavingOut, ChangesNoBit) {
    ApiOptions options;
    options.skips = GetParam();
    expectPublished(options);
}

INSTANTIATE_TEST_SUITE_P(PublishedBits, LeavingOut,
                         testing::Values("off", "unread_outputs=off", "per_vertex_work=off", "shared_samples=off",
                                         "idle_state=off", "unkept_fragments=off", "helper_invocations=off",
                                         "hidden_work=off", "coarse_depth=off"));

}  // namespace
}  // namespace vernier::conformance
