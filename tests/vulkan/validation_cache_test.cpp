// VK_EXT_validation_cache: caches remember modules that were found valid, in data that outlives them.
#include <algorithm>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

class ValidationCacheTest : public DrawTest {
  protected:
    using Data = std::vector<uint8_t>;
    static constexpr size_t kHeader = 8 + VK_UUID_SIZE;

    std::vector<const char*> moreExtensions() override { return {VK_EXT_VALIDATION_CACHE_EXTENSION_NAME}; }
    void SetUp() override {
        // The layer's caches are its own.
        VERNIER_SKIP_WHEN_VALIDATED();
        DrawTest::SetUp();
        get_ = command<PFN_vkGetValidationCacheDataEXT>("vkGetValidationCacheDataEXT");
    }

    VkValidationCacheEXT makeCache(const Data& data = {}) {
        auto info = make<VkValidationCacheCreateInfoEXT>(VK_STRUCTURE_TYPE_VALIDATION_CACHE_CREATE_INFO_EXT);
        info.initialDataSize = data.size();
        info.pInitialData = data.data();
        VkValidationCacheEXT cache = VK_NULL_HANDLE;
        EXPECT_EQ(command<PFN_vkCreateValidationCacheEXT>("vkCreateValidationCacheEXT")(device, &info, nullptr, &cache),
                  VK_SUCCESS);
        defer([this, cache] {
            command<PFN_vkDestroyValidationCacheEXT>("vkDestroyValidationCacheEXT")(device, cache, nullptr);
        });
        return cache;
    }
    Data dataOf(VkValidationCacheEXT cache) {
        size_t size = 0;
        EXPECT_EQ(get_(device, cache, &size, nullptr), VK_SUCCESS);
        Data data(size);
        EXPECT_EQ(get_(device, cache, &size, data.data()), VK_SUCCESS);
        EXPECT_EQ(size, data.size());
        return data;
    }
    VkResult createModule(const std::vector<uint32_t>& words, VkValidationCacheEXT cache,
                          VkShaderModule* made = nullptr) {
        auto use = make<VkShaderModuleValidationCacheCreateInfoEXT>(
            VK_STRUCTURE_TYPE_SHADER_MODULE_VALIDATION_CACHE_CREATE_INFO_EXT);
        use.validationCache = cache;
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, &use);
        info.codeSize = words.size() * sizeof(uint32_t);
        info.pCode = words.data();
        VkShaderModule module = VK_NULL_HANDLE;
        const VkResult result = vkCreateShaderModule(device, &info, nullptr, &module);
        if (result == VK_SUCCESS) defer([this, module] { vkDestroyShaderModule(device, module, nullptr); });
        if (made != nullptr) *made = module;
        return result;
    }
    static std::vector<uint32_t> code(const std::string& value) {
        return compileGlsl(VK_SHADER_STAGE_VERTEX_BIT,
                           "#version 450\nvoid main() { gl_Position = vec4(" + value + "); }");
    }

    PFN_vkGetValidationCacheDataEXT get_ = nullptr;
};

TEST_F(ValidationCacheTest, modulesAreRememberedOnce) {
    const VkValidationCacheEXT cache = makeCache();
    const Data empty = dataOf(cache);
    ASSERT_EQ(empty.size(), kHeader);
    uint32_t words[2];
    std::memcpy(words, empty.data(), sizeof words);
    EXPECT_EQ(words[0], kHeader);
    EXPECT_EQ(words[1], uint32_t{VK_VALIDATION_CACHE_HEADER_VERSION_ONE_EXT});
    EXPECT_EQ(createModule(code("1"), cache), VK_SUCCESS);
    const Data one = dataOf(cache);
    EXPECT_GT(one.size(), kHeader);
    EXPECT_EQ(createModule(code("1"), cache), VK_SUCCESS);
    EXPECT_EQ(dataOf(cache), one);
    EXPECT_EQ(createModule(code("2"), cache), VK_SUCCESS);
    EXPECT_EQ(dataOf(cache).size() - one.size(), one.size() - kHeader);
}

TEST_F(ValidationCacheTest, knownModulesDraw) {
    constexpr VkExtent2D kExtent{8, 8};
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    const std::vector<uint32_t> words =
        compileGlsl(VK_SHADER_STAGE_FRAGMENT_BIT,
                    "#version 450\nlayout(location = 0) out vec4 o;\nvoid main() { o = vec4(1, 0, 0, 1); }");
    const VkValidationCacheEXT cache = makeCache();
    EXPECT_EQ(createModule(words, cache), VK_SUCCESS);
    PipelineDesc desc;
    desc.extent = kExtent;
    desc.vertex = fullScreen();
    ASSERT_EQ(createModule(words, cache, &desc.fragment), VK_SUCCESS);
    drawTriangle(pass, makePipeline(pass.pass, desc));
    EXPECT_EQ(pixelAt(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4), color, 4, 4), 0xFF0000FFu);
}

// What is not valid is refused, with a cache that knows it not, and one that knows its like.
TEST_F(ValidationCacheTest, wrongModulesAreNotRemembered) {
    const VkValidationCacheEXT cache = makeCache();
    std::vector<uint32_t> wrong = code("1");
    wrong[3] = 0;  // the bound of ids
    EXPECT_NE(createModule(wrong, cache), VK_SUCCESS);
    EXPECT_EQ(dataOf(cache).size(), kHeader);
    EXPECT_EQ(createModule(code("1"), cache), VK_SUCCESS);
    EXPECT_NE(createModule(wrong, cache), VK_SUCCESS);
}

TEST_F(ValidationCacheTest, dataGoesFromCacheToCache) {
    const VkValidationCacheEXT first = makeCache(), second = makeCache();
    for (const char* const value : {"1", "2", "3"}) EXPECT_EQ(createModule(code(value), first), VK_SUCCESS);
    for (const char* const value : {"3", "4"}) EXPECT_EQ(createModule(code(value), second), VK_SUCCESS);
    const Data three = dataOf(first), two = dataOf(second);
    EXPECT_EQ(dataOf(makeCache(three)), three);
    const VkValidationCacheEXT all = makeCache(three), empty = makeCache();
    const VkValidationCacheEXT sources[] = {empty, second};
    EXPECT_EQ(command<PFN_vkMergeValidationCachesEXT>("vkMergeValidationCachesEXT")(device, all, 2, sources),
              VK_SUCCESS);
    const size_t each = (two.size() - kHeader) / 2;
    EXPECT_EQ(dataOf(all).size(), kHeader + 4 * each);
    EXPECT_EQ(dataOf(second), two);
    // Of another driver, and cut off.
    Data foreign = three;
    foreign[kHeader - 1] ^= 1;
    EXPECT_EQ(dataOf(makeCache(foreign)).size(), kHeader);
    EXPECT_EQ(dataOf(makeCache(Data(three.begin(), three.begin() + kHeader + 1))).size(), kHeader);
}

TEST_F(ValidationCacheTest, dataThatDoesNotFitIsCut) {
    const VkValidationCacheEXT cache = makeCache();
    for (const char* const value : {"1", "2"}) EXPECT_EQ(createModule(code(value), cache), VK_SUCCESS);
    const Data whole = dataOf(cache);
    const size_t each = (whole.size() - kHeader) / 2;
    for (size_t room = 0; room < whole.size(); ++room) {
        Data part(whole.size(), 0xAA);
        size_t size = room;
        EXPECT_EQ(get_(device, cache, &size, part.data()), VK_INCOMPLETE);
        EXPECT_EQ(size, room < kHeader ? 0 : kHeader + (room - kHeader) / each * each) << room;
        EXPECT_TRUE(std::equal(part.begin(), part.begin() + static_cast<ptrdiff_t>(size), whole.begin()));
        EXPECT_TRUE(
            std::all_of(part.begin() + static_cast<ptrdiff_t>(size), part.end(), [](uint8_t b) { return b == 0xAA; }));
    }
}

}  // namespace
}  // namespace vernier::test
