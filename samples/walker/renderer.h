// Draws what a player sees, in either version, as colours or as the numbers of the surfaces.
#pragma once

#include "samples/common/app.h"
#include "samples/walker/columns.h"
#include "samples/walker/solid.h"

namespace samples {

class WalkerRenderer {
  public:
    WalkerRenderer(App& app, const Map& map);

    /// In passes of its own. `numbers` is an image of VK_FORMAT_R32_UINT that gets surfaceNumber() + 1 for every pixel,
    /// and 0 where nothing is; without it the colours go to the app's picture.
    void drawColumns(const View& view, const Target* numbers = nullptr);
    void drawSolid(const View& view, const Target* numbers = nullptr);
    const ColumnStatistics& statistics() const { return statistics_; }

  private:
    struct Version {
        VnProgram colors{}, numbers{};
    };
    void beginPass(const Target* numbers);
    void pushAndBind(const Version& version, const View& view, const Target* numbers);

    App& app_;
    const Map& map_;
    Version columns_, solid_;
    VnVertexLayout columnLayout_, solidLayout_;
    VnBuffer lines_{}, triangles_{};
    uint64_t lineCapacity_ = 0;
    uint32_t triangleVertices_ = 0;
    VnDepthStencilState depth_;
    VnRasterState front_;
    ColumnStatistics statistics_;
};

}  // namespace samples
