// Draws Dear ImGui's windows with Vernier: what imgui_impl_vulkan.cpp is to Vulkan.
//
//   ImDrawList::VtxBuffer, IdxBuffer   vertex and index buffers that grow, filled by vnUpdateBuffer
//   ImDrawCmd::ClipRect                vnSetScissor
//   ImDrawCmd::TextureId               the id of a VnView
//   the font atlas                     an image of one byte per texel, its view's swizzle making it white with alpha
//   blending of sRGB-encoded colours   a view of the sRGB picture as VK_FORMAT_R8G8B8A8_UNORM
#pragma once

#include <imgui.h>

#include "samples/common/app.h"

namespace samples {

/// Owns the current ImGuiContext: one at a time.
class ImguiVernier {
  public:
    /// Letters `fontPixels` high.
    ImguiVernier(App& app, float fontPixels);
    ~ImguiVernier();
    ImguiVernier(const ImguiVernier&) = delete;
    ImguiVernier& operator=(const ImguiVernier&) = delete;

    /// Starts ImGui's frame with what the user did.
    void beginFrame(const Input& input, double elapsed);
    /// Ends it and draws it over App::color().
    void endFrame();
    /// The mouse is over a window of ImGui's or held by one.
    bool wantsMouse() const { return ImGui::GetIO().WantCaptureMouse; }

  private:
    /// A buffer that is made anew when more is wanted than it holds.
    struct Growing {
        VnBuffer buffer{};
        uint64_t size = 0;
    };
    void reserve(Growing& buffer, uint64_t bytes);
    void makeFont(float pixels);
    void upload(const ImDrawData& data);
    void bindState(const ImDrawData& data);

    App& app_;
    VnProgram program_;
    VnVertexLayout layout_;
    VnBlendState over_{};
    VnSampler sampler_;
    VnImage font_{};
    VnView fontView_{};
    Growing vertices_, indices_;
};

}  // namespace samples
