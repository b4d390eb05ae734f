#include "samples/walker/view.h"

#include "samples/common/trigonometry.h"

namespace samples {

Seen seenFrom(const View& view, const Point& point) {
    const double c = cosine(view.angle), s = sine(view.angle), dx = point.x - view.place.x, dy = point.y - view.place.y;
    return {dx * s - dy * c, dx * c + dy * s};
}

glm::mat4 clipTransform(const View& view) {
    const double c = cosine(view.angle), s = sine(view.angle);
    // Rows in terms of (x, y, height, 1).
    const double right[4] = {s, -c, 0, -view.place.x * s + view.place.y * c};
    const double distance[4] = {c, s, 0, -view.place.x * c - view.place.y * s};
    const double up[4] = {0, 0, 1, -view.eye};
    const double acrossScale = 2 * view.scale() / view.width, downScale = -2 * view.scale() / view.height;
    const double depthScale = kFarthest / (kFarthest - kNearest);
    glm::mat4 m(0);
    for (int i = 0; i < 4; ++i) {
        m[i][0] = static_cast<float>(right[i] * acrossScale);
        m[i][1] = static_cast<float>((up[i] + view.shear * distance[i]) * downScale);
        m[i][2] = static_cast<float>((distance[i] - (i == 3 ? kNearest : 0)) * depthScale);
        m[i][3] = static_cast<float>(distance[i]);
    }
    return m;
}

}  // namespace samples
