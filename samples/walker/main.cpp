// A walk through sectors and portals, in two versions side by side: vertical lines, column by column, and triangles
// with a depth buffer. Tab or T switches, W A S D and the arrows walk and turn, dragging looks around, space jumps,
// control ducks. Without a window, and with --walk, the walk goes by itself to the farthest sector and back.
//   walker [MAP] [--maze SEED] [--version columns|triangles|both] [--frames N --out DIR]
#include <cstdio>
#include <optional>

#include "samples/walker/maze.h"
#include "samples/walker/player.h"
#include "samples/walker/renderer.h"

namespace {

constexpr int kColumns = 0, kBoth = 2;

samples::Intent intentOf(const samples::Input& input, double mouseShare) {
    samples::Intent intent;
    intent.forward = input.axis('s', 'w') + input.axis(samples::kKeyDown, samples::kKeyUp);
    intent.right = input.axis('a', 'd');
    intent.turn = -input.axis(samples::kKeyLeft, samples::kKeyRight) * 0.04f;
    intent.look = input.axis('f', 'r') * 0.02f;
    if (input.dragging) {
        intent.turn -= input.mouseMove.x * 0.005 * mouseShare;
        intent.look -= input.mouseMove.y * 0.005 * mouseShare;
    }
    intent.jump = input.isHeld(' ');
    intent.duck = input.isHeld(samples::kKeyControl);
    return intent;
}

}  // namespace

int main(int argc, char** argv) {
    std::string file = WALKER_MAPS "/castle.map";
    int mazeSeed = -1, mazeColumns = 25, mazeRows = 20, version = kColumns;
    bool walk = false;
    samples::App app(
        argc, argv, "Walker",
        {{"map", "a map (the castle)", &file},
         {"--maze", "a maze made from this number instead of a map", &mazeSeed},
         {"--columns", "of the maze (25)", &mazeColumns},
         {"--rows", "of the maze (20)", &mazeRows},
         {"--version", "columns, triangles or both side by side", &version, 't', {"columns", "triangles", "both"}},
         {"--walk", "walk by itself", &walk, 'g'}});
    samples::Map map;
    std::string error;
    const auto side = [](int count) { return static_cast<uint32_t>(glm::clamp(count, 1, 200)); };
    const bool read =
        mazeSeed >= 0
            ? samples::parseMap(samples::mazeMap(side(mazeColumns), side(mazeRows), static_cast<uint64_t>(mazeSeed)),
                                "maze", map, error)
            : samples::loadMap(file, map, error);
    if (!read) {
        std::fprintf(stderr, "%s\n", error.c_str());
        return 1;
    }
    samples::WalkerRenderer renderer(app, map);
    samples::Player player(map);
    samples::Guide guide(map);
    uint64_t steps = 0;
    // The left half of one version beside the right half of the other.
    const samples::Target& other = app.windowTarget(VK_FORMAT_R8G8B8A8_SRGB);

    return app.run([&](const samples::Frame& frame) {
        // Steps of one length, so that the picture of a moment does not depend on the frames before.
        const auto wanted = static_cast<uint64_t>(frame.seconds / samples::kPlayerStep);
        const uint64_t count = wanted > steps ? wanted - steps : 0;
        for (; steps < wanted; ++steps)
            player.step(walk || !app.hasWindow() ? guide.intent(player)
                                                 : intentOf(frame.input, 1.0 / static_cast<double>(count)));
        samples::View view;
        view.place = player.place();
        view.eye = player.eye();
        view.angle = player.angle();
        view.shear = player.shear();
        view.sector = player.sector();
        view.width = app.width();
        view.height = app.height();
        if (version == kColumns || version == kBoth) renderer.drawColumns(view);
        if (version == kBoth) {
            vnCopyImage(app.context(), app.color().image, nullptr, other.image, nullptr);
            renderer.drawSolid(view);
            VnRegion half{};
            half.width = app.width() / 2;
            half.height = app.height();
            vnCopyImage(app.context(), other.image, &half, app.color().image, &half);
        } else if (version != kColumns) {
            renderer.drawSolid(view);
        }
    });
}
