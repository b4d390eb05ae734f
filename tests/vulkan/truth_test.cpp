// Whether the driver tells the truth about itself: everything that it reports has a row in truth.txt that names the
// tests or scenes which exercise it, all of these exist, and there are no rows for things that are not reported. That
// they do exercise features is for truth_hidden.py.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "conformance/scenes/scenes.h"
#include "tests/vulkan/test_device.h"

namespace vernier::test {
namespace {

namespace fs = std::filesystem;

std::string contentsOf(const fs::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Row {
    int line = 0;
    std::vector<std::string> evidence;
};

std::string trimmed(const std::string& text) {
    const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// "KIND NAME" to its row. Malformed lines and second rows for the same thing fail.
std::map<std::string, Row> readTable() {
    std::map<std::string, Row> rows;
    std::ifstream file(VERNIER_TRUTH_TABLE);
    EXPECT_TRUE(file.is_open()) << VERNIER_TRUTH_TABLE;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        if (trimmed(line).empty() || line[0] == '#') continue;
        std::stringstream columns(line);
        std::string key, evidence, silent;
        std::getline(columns, key, '|');
        std::getline(columns, evidence, '|');
        std::getline(columns, silent);
        key = trimmed(key);
        Row row{number, {}};
        std::stringstream list(evidence);
        for (std::string one; std::getline(list, one, ',');) row.evidence.push_back(trimmed(one));
        const bool says = silent.empty() || (key.starts_with("feature ") && trimmed(silent).starts_with("silent: "));
        if (row.evidence.empty() || std::count(key.begin(), key.end(), ' ') != 1 || !says) {
            ADD_FAILURE() << "truth.txt:" << number
                          << ": not KIND NAME | EVIDENCE, nor feature NAME | ... | silent: ...";
        }
        if (!rows.emplace(key, row).second) ADD_FAILURE() << "truth.txt:" << number << ": a second row for " << key;
    }
    return rows;
}

/// The names of the tests in sources that some CMakeLists.txt beside them names, and of what CTest runs.
std::set<std::string> existingTests() {
    std::set<std::string> names;
    const std::regex test(R"(TEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
    const std::regex ctest(R"((?:vernier_test\(|add_test\(NAME )(\w+))");
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(VERNIER_TESTS)) {
        if (entry.path().filename() == "CMakeLists.txt") {
            const std::string text = contentsOf(entry.path());
            for (std::sregex_iterator i(text.begin(), text.end(), ctest), end; i != end; ++i) names.insert((*i)[1]);
        }
        if (entry.path().extension() != ".cpp") continue;
        const std::string list = contentsOf(entry.path().parent_path() / "CMakeLists.txt");
        // By its name, or by what stands before _test.cpp, of which a loop there makes the rest.
        std::string stem = entry.path().stem().string();
        if (stem.size() > 5 && stem.ends_with("_test")) stem.resize(stem.size() - 5);
        if (!std::regex_search(list, std::regex("\\b" + stem + "(_test\\.cpp|\\.cpp)?\\b"))) continue;
        const std::string text = contentsOf(entry.path());
        for (std::sregex_iterator i(text.begin(), text.end(), test), end; i != end; ++i)
            names.insert((*i)[1].str() + "." + (*i)[2].str());
    }
    return names;
}

/// Collects "KIND NAME" of all that the device reports.
class Reported {
  public:
    explicit Reported(VkPhysicalDevice device) : device_(device) {
        features();
        properties();
        limits();
        formats();
    }
    const std::set<std::string>& names() const { return names_; }

  private:
    template <class T>
    T featuresOf(VkStructureType type) {
        T structure{};
        structure.sType = type;
        auto all = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &structure);
        vkGetPhysicalDeviceFeatures2(device_, &all);
        return structure;
    }
    void features() {
        VkPhysicalDeviceFeatures VkPhysicalDeviceFeatures_{};
        vkGetPhysicalDeviceFeatures(device_, &VkPhysicalDeviceFeatures_);
#define VERNIER_FEATURES(type, value) const type type##_ = featuresOf<type>(value);
#define VERNIER_FEATURE(type, member) \
    if (type##_.member != VK_FALSE) names_.insert("feature " #member);
#include "reported_features.inc"
#undef VERNIER_FEATURES
#undef VERNIER_FEATURE
    }

    /// The structure as the device leaves it, from bytes that are all `before`.
    template <class T>
    T propertiesOf(VkStructureType type, int before) {
        T structure;
        std::memset(static_cast<void*>(&structure), before, sizeof structure);
        structure.sType = type;
        structure.pNext = nullptr;
        auto all = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &structure);
        vkGetPhysicalDeviceProperties2(device_, &all);
        return structure;
    }
    /// What comes out the same from different bytes has been written; zeros promise nothing.
    template <class Member>
    static bool promised(const Member& one, const Member& other) {
        return std::memcmp(&one, &other, sizeof one) == 0 && promises(one);
    }
    template <class Member>
    static bool promises(const Member& member) {
        const auto* bytes = reinterpret_cast<const uint8_t*>(&member);
        return std::any_of(bytes, bytes + sizeof member, [](uint8_t byte) { return byte != 0; });
    }
    void properties() {
#define VERNIER_PROPERTIES(type, value)                      \
    const type type##_one = propertiesOf<type>(value, 0x55); \
    const type type##_other = propertiesOf<type>(value, 0xAA);
#define VERNIER_PROPERTY(type, member) \
    if (promised(type##_one.member, type##_other.member)) names_.insert("property " #member);
#include "reported_properties.inc"
#undef VERNIER_PROPERTIES
#undef VERNIER_PROPERTY
    }

    void limits() {
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(device_, &properties);
#define VERNIER_LIMIT(member) \
    if (promises(properties.limits.member)) names_.insert("limit " #member);
#include "reported_limits.inc"
#undef VERNIER_LIMIT
    }

    void formats() {
        VkFormatFeatureFlags optimal = 0, linear = 0, buffer = 0;
        const auto add = [&](VkFormat format) {
            VkFormatProperties properties{};
            vkGetPhysicalDeviceFormatProperties(device_, format, &properties);
            optimal |= properties.optimalTilingFeatures;
            linear |= properties.linearTilingFeatures;
            buffer |= properties.bufferFeatures;
        };
#define VERNIER_FORMAT(format) add(format);
#define VERNIER_FORMAT_BIT(name, bit)
#include "reported_formats.inc"
#undef VERNIER_FORMAT
#undef VERNIER_FORMAT_BIT
#define VERNIER_FORMAT(format)
#define VERNIER_FORMAT_BIT(name, bit)                                   \
    if ((optimal & (bit)) != 0) names_.insert("format optimal." #name); \
    if ((linear & (bit)) != 0) names_.insert("format linear." #name);   \
    if ((buffer & (bit)) != 0) names_.insert("format buffer." #name);
#include "reported_formats.inc"
#undef VERNIER_FORMAT
#undef VERNIER_FORMAT_BIT
    }

    VkPhysicalDevice device_;
    std::set<std::string> names_;
};

class TruthTest : public VulkanTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
};

TEST_F(TruthTest, whatIsReportedHasARow) {
    const std::map<std::string, Row> rows = readTable();
    const Reported reported(physicalDevice);
    for (const std::string& name : reported.names())
        EXPECT_TRUE(rows.count(name) != 0) << "reported, but no row in truth.txt: " << name;
}

TEST_F(TruthTest, rowsAreOfWhatIsReported) {
    const std::map<std::string, Row> rows = readTable();
    const Reported reported(physicalDevice);
    for (const auto& [name, row] : rows)
        EXPECT_TRUE(reported.names().count(name) != 0) << "truth.txt:" << row.line << ": not reported: " << name;
}

TEST_F(TruthTest, theTestsOfAllRowsExist) {
    const std::set<std::string> tests = existingTests();
    ASSERT_GT(tests.size(), 100u);
    for (const auto& [name, row] : readTable()) {
        for (const std::string& evidence : row.evidence) {
            const bool exists = evidence.rfind("scene ", 0) == 0 ? conformance::findScene(evidence.substr(6)) != nullptr
                                                                 : tests.count(evidence) != 0;
            EXPECT_TRUE(exists) << "truth.txt:" << row.line << ": no such test: " << evidence;
        }
    }
}

}  // namespace
}  // namespace vernier::test
