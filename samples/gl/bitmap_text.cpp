// Text from a bitmap font: a texture with all characters, and one instance of a square for each letter.
//
//   glTexImage2D(GL_R8)                       vnCreateImage with VK_FORMAT_R8_UNORM
//   glPixelStorei(GL_UNPACK_ALIGNMENT, 1)     nothing: rows are tightly packed
//   glRasterPos, glBitmap, glCallLists        a buffer with a place and a character per instance
//   glOrtho(0, width, height, 0, ...)         a division by the window's size; y runs down as it is
//   glVertexAttribIPointer                    an attribute with an integer format, e.g. VK_FORMAT_R32_UINT
//   glBufferSubData each frame                vnUpdateBuffer
//   glEnable(GL_BLEND)                        VnBlendStateDesc
#include <cstdio>

#include "samples/common/app.h"
#include "samples/common/font.h"
#include "samples/common/trigonometry.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { vec2 window; };
layout(location = 0) in vec3 place;  // upper left corner and height of the cell, in pixels
layout(location = 1) in uint character;
layout(location = 2) in vec4 tint;
layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 color;
const vec2 cells = vec2(16, 6);
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    uv = (vec2(character % 16u, character / 16u) + corner) / cells;
    color = tint;
    vec2 pixel = place.xy + corner * place.z * vec2(0.6, 1);
    gl_Position = vec4(pixel / window * 2 - 1, 0, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D font;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = vec4(color.rgb, color.a * texture(font, uv).r); })";

struct Letter {
    glm::vec3 place;
    uint32_t character;
    glm::vec4 color;
};

void print(std::vector<Letter>& letters, float x, float y, float height, const glm::vec4& color,
           const std::string& text) {
    float left = x;
    for (const char c : text) {
        if (c == '\n') {
            left = x;
            y += height;
            continue;
        }
        const bool known = c >= ' ' && c <= '~';
        letters.push_back({{left, y, height}, known ? static_cast<uint32_t>(c) - samples::kFontFirst : 95u, color});
        left += height * 0.6f;
    }
}

std::vector<Letter> page(double seconds, float width) {
    std::vector<Letter> letters;
    print(letters, 30, 24, 60, {1, 0.8f, 0.3f, 1}, "Vernier");
    print(letters, 30, 96, 24, {0.6f, 0.75f, 1, 1}, "Text from a bitmap font, drawn as instances.");
    std::string all;
    for (char c = ' '; c <= '~'; ++c) {
        all += c;
        if ((c - ' ') % 32 == 31) all += '\n';
    }
    print(letters, 30, 150, 36, {1, 1, 1, 1}, all);
    const std::string pangram = "The five boxing wizards jump quickly.";
    for (size_t i = 0; i < pangram.size(); ++i) {
        const double phase = static_cast<double>(i) * 0.4 + seconds * 3;
        const glm::vec4 color(0.5f + 0.5f * samples::cosineF(phase), 0.7f, 0.5f + 0.5f * samples::sineF(phase), 1);
        print(letters, 30 + static_cast<float>(i) * 19, 340 + 14 * samples::sineF(phase), 30, color,
              pangram.substr(i, 1));
    }
    for (float height = 10, y = 410; height < 42; y += height + 2, height += 5)
        print(letters, 30, y, height, {0.7f, 0.9f, 0.7f, 1},
              "0123456789 +-*/ (height " + std::to_string(int(height)) + ")");
    char clock[32];
    std::snprintf(clock, sizeof clock, "%6.1f s", seconds);
    print(letters, width - 200, 30, 36, {1, 0.5f, 0.5f, 1}, clock);
    return letters;
}

}  // namespace

int main(int argc, char** argv) {
    samples::App app(argc, argv, "Bitmap text");
    VnContext context = app.context();
    constexpr uint32_t kUnit = 6;
    const std::vector<uint8_t> texels = samples::fontTexels(kUnit);
    const samples::Target font =
        app.target(VK_FORMAT_R8_UNORM, samples::kFontColumns * 6 * kUnit, samples::kFontRows * 10 * kUnit);
    vnUpdateImage(context, font.image, nullptr, texels.data(), texels.size());
    const VnProgram program = app.program(kVertex, kFragment);
    const VnVertexLayout layout = app.layout({{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Letter, place)},
                                              {1, 0, VK_FORMAT_R32_UINT, offsetof(Letter, character)},
                                              {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Letter, color)}},
                                             {{sizeof(Letter), 1}});
    const VnBlendState over = app.blendState(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    const VnSampler linear = app.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    const VnBuffer letterBuffer = app.buffer(std::vector<Letter>(1024));

    return app.run([&](const samples::Frame& frame) {
        std::vector<Letter> letters = page(frame.seconds, static_cast<float>(app.width()));
        letters.resize(std::min(letters.size(), size_t{1024}));
        app.update(letterBuffer, letters);
        app.beginPass({0.03f, 0.04f, 0.07f, 1});
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, letterBuffer, 0);
        vnBindBlendState(context, over);
        vnBindTexture(context, 0, 0, 0, font.view, linear);
        app.push(glm::vec2(app.width(), app.height()));
        vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, 0);
        vnDraw(context, 4, static_cast<uint32_t>(letters.size()), 0, 0);
        app.endPass();
    });
}
