#include "samples/viewer/imgui_vernier.h"

#include <algorithm>
#include <cmath>

namespace samples {
namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { vec2 scale; vec2 offset; };
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 textureCoordinate;
layout(location = 2) in vec4 vertexColor;
layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 color;
void main() {
    uv = textureCoordinate;
    color = vertexColor;
    gl_Position = vec4(position * scale + offset, 0, 1);
})";

constexpr const char* kFragment = R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;
void main() { result = color * texture(image, uv); })";

}  // namespace

ImguiVernier::ImguiVernier(App& app, float fontPixels)
    : app_(app),
      program_(app.program(kVertex, kFragment)),
      layout_(app.layout({{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
                          {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
                          {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}},
                         {{sizeof(ImDrawVert), 0}})),
      sampler_(app.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // where windows lie is not kept
    io.BackendRendererName = "vernier";
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    // Square corners: ImGui makes round ones with the C library's sine, which pictures keep clear of.
    style.WindowRounding = style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = style.TabRounding = 0;
    style.Colors[ImGuiCol_WindowBg].w = 1;
    style.ScaleAllSizes(std::max(1.0f, std::round(fontPixels / 13)));
    VnBlendStateDesc over{};
    over.attachments[0].enable = 1;  // source over
    must(vnCreateBlendState(app.device(), &over, &over_));
    makeFont(fontPixels);
}

ImguiVernier::~ImguiVernier() {
    ImGui::DestroyContext();
    vnDestroyImage(app_.device(), font_);
    for (const Growing& growing : {vertices_, indices_})
        if (growing.buffer.id) vnDestroyBuffer(app_.device(), growing.buffer);
}

void ImguiVernier::makeFont(float pixels) {
    ImGuiIO& io = ImGui::GetIO();
    ImFontConfig config;
    config.SizePixels = pixels;
    io.Fonts->AddFontDefault(&config);
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
    VnImageDesc desc{};
    desc.format = VK_FORMAT_R8_UNORM;
    desc.width = static_cast<uint32_t>(width);
    desc.height = static_cast<uint32_t>(height);
    must(vnCreateImage(app_.device(), &desc, &font_));
    must(vnUpdateImage(app_.context(), font_, nullptr, texels,
                       static_cast<uint64_t>(width) * static_cast<uint64_t>(height)));
    VnViewDesc view{};
    view.image = font_;
    view.swizzle = {VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_ONE,
                    VK_COMPONENT_SWIZZLE_R};
    must(vnCreateView(app_.device(), &view, &fontView_));
    io.Fonts->SetTexID(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(fontView_.id)));
}

void ImguiVernier::beginFrame(const Input& input, double elapsed) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(app_.width()), static_cast<float>(app_.height()));
    io.DeltaTime = static_cast<float>(elapsed > 0 ? elapsed : 1 / 60.0);
    io.MousePos = ImVec2(input.mouse.x, input.mouse.y);
    io.MouseDown[0] = input.dragging;
    io.MouseWheel = input.wheel;
    ImGui::NewFrame();
}

void ImguiVernier::reserve(Growing& buffer, uint64_t bytes) {
    if (bytes <= buffer.size) return;
    if (buffer.buffer.id) must(vnDestroyBuffer(app_.device(), buffer.buffer));
    buffer.size = bytes + bytes / 2;
    VnBufferDesc desc{};
    desc.size = buffer.size;
    must(vnCreateBuffer(app_.device(), &desc, &buffer.buffer));
}

void ImguiVernier::upload(const ImDrawData& data) {
    std::vector<uint8_t> vertices, indices;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        const auto add = [](std::vector<uint8_t>& to, const auto& vector) {
            const auto* bytes = reinterpret_cast<const uint8_t*>(vector.Data);
            to.insert(to.end(), bytes, bytes + static_cast<size_t>(vector.Size) * sizeof(vector.Data[0]));
        };
        add(vertices, list.VtxBuffer);
        add(indices, list.IdxBuffer);
    }
    reserve(vertices_, vertices.size());
    reserve(indices_, indices.size());
    must(vnUpdateBuffer(app_.context(), vertices_.buffer, 0, vertices.data(), vertices.size()));
    must(vnUpdateBuffer(app_.context(), indices_.buffer, 0, indices.data(), indices.size()));
}

void ImguiVernier::bindState(const ImDrawData& data) {
    VnContext context = app_.context();
    vnBindProgram(context, program_);
    vnBindVertexLayout(context, layout_);
    vnBindRasterState(context, VnRasterState{});
    vnBindDepthStencilState(context, VnDepthStencilState{});
    vnBindBlendState(context, over_);
    vnSetTopology(context, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, 0);
    vnBindVertexBuffer(context, 0, vertices_.buffer, 0);
    vnBindIndexBuffer(context, indices_.buffer, 0,
                      sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    const glm::vec2 scale(2 / data.DisplaySize.x, 2 / data.DisplaySize.y);
    const glm::vec4 push(scale, -1 - data.DisplayPos.x * scale.x, -1 - data.DisplayPos.y * scale.y);
    app_.push(push);
}

void ImguiVernier::endFrame() {
    ImGui::Render();
    const ImDrawData& data = *ImGui::GetDrawData();
    if (data.TotalVtxCount == 0) return;
    upload(data);
    VnContext context = app_.context();
    // The picture's texels as they are stored: ImGui blends those.
    VnViewDesc encoded{};
    encoded.image = app_.color().image;
    encoded.format = VK_FORMAT_R8G8B8A8_UNORM;
    VnPassDesc pass{};
    must(vnCreateView(app_.device(), &encoded, &pass.colors[0].view));
    must(vnBeginPass(context, &pass));
    bindState(data);
    uint32_t firstIndex = 0;
    int32_t firstVertex = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            // Nobody here asks for callbacks; those that only reset the state need nothing.
            if (command.UserCallback || command.ElemCount == 0) continue;
            const auto width = static_cast<float>(app_.width()), height = static_cast<float>(app_.height());
            const float left = std::clamp(command.ClipRect.x - data.DisplayPos.x, 0.0f, width);
            const float top = std::clamp(command.ClipRect.y - data.DisplayPos.y, 0.0f, height);
            const float right = std::clamp(command.ClipRect.z - data.DisplayPos.x, left, width);
            const float bottom = std::clamp(command.ClipRect.w - data.DisplayPos.y, top, height);
            const VkRect2D scissor{{static_cast<int32_t>(left), static_cast<int32_t>(top)},
                                   {static_cast<uint32_t>(right) - static_cast<uint32_t>(left),
                                    static_cast<uint32_t>(bottom) - static_cast<uint32_t>(top)}};
            if (scissor.extent.width == 0 || scissor.extent.height == 0) continue;
            vnSetScissor(context, &scissor);
            vnBindTexture(context, 0, 0, 0, VnView{reinterpret_cast<uintptr_t>(command.GetTexID())}, sampler_);
            must(vnDrawIndexed(context, command.ElemCount, 1, firstIndex + command.IdxOffset,
                               firstVertex + static_cast<int32_t>(command.VtxOffset), 0));
        }
        firstIndex += static_cast<uint32_t>(list.IdxBuffer.Size);
        firstVertex += list.VtxBuffer.Size;
    }
    vnBindBlendState(context, VnBlendState{});
    must(vnEndPass(context));
    must(vnDestroyView(app_.device(), pass.colors[0].view));
}

}  // namespace samples
