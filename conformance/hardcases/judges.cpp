#include "conformance/hardcases/judges.h"

#include "conformance/differ/classify.h"
#include "conformance/hardcases/coverage_input.h"
#include "conformance/oracle/oracle.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <map>
#include <memory>

namespace vernier::conformance::hardcases {
namespace {

std::string channelValue(const exact::PixelFormat& format, const RenderedImage& image, size_t pixel) {
    std::string text;
    for (const exact::Component& c : format.all()) {
        const uint64_t code = exact::extractBits(image.texels.data() + pixel * format.bytes, c.offset, c.bits);
        const bool isFloat = c.encoding == exact::Encoding::sfloat && c.bits == 32;
        char number[48];
        if (isFloat) {
            std::snprintf(number, sizeof number, "%.9g",
                          static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(code))));
        } else {
            std::snprintf(number, sizeof number, "%llu", static_cast<unsigned long long>(code));
        }
        text += (text.empty() ? "" : ", ") + std::string(number);
    }
    return "(" + text + ")";
}

std::string interval(const exact::PixelFormat& format, const OraclePixel& pixel) {
    std::string text;
    for (const exact::Component& c : format.all()) {
        char number[120];
        std::snprintf(number, sizeof number, "%.9g in [%.9g, %.9g]", pixel.value[c.channel], pixel.low[c.channel],
                      pixel.high[c.channel]);
        text += (text.empty() ? "" : "; ") + std::string(number);
    }
    return text;
}

Verdict compare(const RenderedImage& image, const OracleImage& oracle) {
    const Result<ImageDiff> compared = compareWithOracle(image, oracle);
    if (!compared) return Verdict::wrong(compared.error().message);
    const ImageDiff& diff = *compared;
    const size_t at = size_t{diff.worstY} * diff.extent.width + diff.worstX;
    const exact::PixelFormat* format = exact::findPixelFormat(image.format);
    if (diff.worstClass == PixelClass::equal || format == nullptr) return {};
    const std::string where = pixelText(diff.worstX, diff.worstY) + " is " + channelValue(*format, image, at) +
                              ", exactly " + interval(*format, oracle.pixels[at]) +
                              ((oracle.pixels[at].flags & kOracleEdge) != 0 ? " (on an edge)" : "");
    if (diff.worstClass == PixelClass::oursWrong) {
        return Verdict::wrong(where + "; " + std::to_string(diff.count(PixelClass::oursWrong)) + " such pixels");
    }
    if (diff.worstClass == PixelClass::undecided) return Verdict::wrong(where + "; not decided by the oracle");
    return Verdict::allowed(where + "; " + std::string(pixelClassText(diff.worstClass)));
}

Verdict compareAll(const Drawn& images, const Result<std::vector<OracleImage>>& oracle) {
    if (!oracle) return Verdict::wrong("not judged: " + oracle.error().message);
    Verdict worst;
    for (size_t i = 0; i < oracle->size(); ++i) {
        if (i >= images.size()) return Verdict::wrong("an image is missing");
        worst = worst.worse(compare(images[i], (*oracle)[i]));
    }
    return worst;
}

// The oracle's answer for one scene, computed once per number of sub-pixel bits.
class OracleAnswers {
  public:
    explicit OracleAnswers(Scene scene) : scene_(std::move(scene)) {}

    Verdict verdictOn(const Drawn& images, const Declared& declared) {
        auto known = answers_.find(declared.subPixelBits);
        if (known == answers_.end()) {
            known = answers_.emplace(declared.subPixelBits, renderOracle(scene_, declared.rules())).first;
        }
        const Verdict verdict = compareAll(images, known->second);
        if (verdict.outcome != Outcome::allowed || !declared.own) return verdict;
        const Verdict own = compareAll(images, renderOracle(scene_, declared.ownRules()));
        if (own.outcome <= Outcome::allowed) return Verdict::declared(own.witness);
        return Verdict::allowed(verdict.witness + "; by the driver's own bounds: " + own.witness);
    }

  private:
    Scene scene_;
    std::map<int, Result<std::vector<OracleImage>>> answers_;
};

}  // namespace

void judgeSame(CaseInput& input, size_t scene, size_t reference, std::string law) {
    input.judge({scene, reference}, [law](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const Drawn &ours = *images[0], &expected = *images[1];
        if (ours.size() != expected.size()) return Verdict::wrong("another number of images");
        for (size_t i = 0; i < ours.size(); ++i) {
            const auto different = std::ranges::mismatch(ours[i].texels, expected[i].texels);
            if (different.in1 == ours[i].texels.end() && different.in2 == expected[i].texels.end()) continue;
            const exact::PixelFormat* format = exact::findPixelFormat(ours[i].format);
            if (format == nullptr || ours[i].texels.size() != expected[i].texels.size()) {
                return Verdict::wrong("images of different sizes; " + law);
            }
            const size_t pixel = static_cast<size_t>(different.in1 - ours[i].texels.begin()) / format->bytes;
            const uint32_t width = ours[i].extent.width;
            return Verdict::wrong(
                pixelText(static_cast<uint32_t>(pixel % width), static_cast<uint32_t>(pixel / width)) + " has codes " +
                channelValue(*format, ours[i], pixel) + ", in the other image " +
                channelValue(*format, expected[i], pixel) + "; " + law);
        }
        return {};
    });
}

void judgeByOracle(CaseInput& input, size_t scene) {
    if (!input.status()) return;
    auto answers = std::make_shared<OracleAnswers>(input.scenes()[scene]);
    input.judge({scene}, [answers](std::span<const Drawn* const> images, const Declared& declared) {
        return answers->verdictOn(*images[0], declared);
    });
}

size_t addForOracle(CaseInput& input, Result<Scene> scene) {
    const size_t index = input.scene(std::move(scene));
    judgeByOracle(input, index);
    return index;
}

PixelReader::PixelReader(const RenderedImage& image) : image_(&image), format_(exact::findPixelFormat(image.format)) {
    if (format_ != nullptr &&
        image.texels.size() != size_t{image.extent.width} * image.extent.height * format_->bytes) {
        format_ = nullptr;
    }
}

uint64_t PixelReader::code(uint32_t x, uint32_t y, uint8_t channel) const {
    const exact::Component* component = format_->channel(channel);
    if (component == nullptr) return 0;
    const size_t offset = (size_t{y} * image_->extent.width + x) * format_->bytes;
    return exact::extractBits(image_->texels.data() + offset, component->offset, component->bits);
}

float PixelReader::number(uint32_t x, uint32_t y, uint8_t channel) const {
    return std::bit_cast<float>(static_cast<uint32_t>(code(x, y, channel)));
}

void judgePixels(CaseInput& input, size_t scene, size_t output, VkExtent2D extent,
                 std::function<Verdict(const PixelReader& pixels, const Declared& declared)> check) {
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        if (output >= images[0]->size()) return Verdict::wrong("an image is missing");
        const PixelReader pixels((*images[0])[output]);
        if (!pixels.valid() || pixels.extent().width != extent.width || pixels.extent().height != extent.height) {
            return Verdict::wrong("an image has the wrong format, extent or size");
        }
        return check(pixels, declared);
    });
}

void judgeCodes(CaseInput& input, size_t scene, size_t output, VkExtent2D extent, std::vector<uint64_t> codes,
                std::string law) {
    judgePixels(input, scene, output, extent, [=](const PixelReader& pixels, const Declared&) -> Verdict {
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) {
                for (const exact::Component& c : pixels.format().all()) {
                    const uint64_t code = pixels.code(x, y, c.channel);
                    if (c.channel >= codes.size() || code == codes[c.channel]) continue;
                    return Verdict::wrong(pixelText(x, y) + " channel " + "RGBA"[c.channel] + " has code " +
                                          std::to_string(code) + ", exactly " + std::to_string(codes[c.channel]) +
                                          "; " + law);
                }
            }
        }
        return {};
    });
}

}  // namespace vernier::conformance::hardcases
