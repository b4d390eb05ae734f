#include "samples/common/transform.h"

#include "samples/common/trigonometry.h"

namespace samples {

glm::mat4 perspective(double fieldOfView, double aspect, double nearPlane, double farPlane) {
    const double f = 1 / tangent(fieldOfView / 2);
    glm::mat4 m(0);
    m[0][0] = static_cast<float>(f / aspect);
    m[1][1] = static_cast<float>(-f);
    m[2][2] = static_cast<float>(farPlane / (nearPlane - farPlane));
    m[2][3] = -1;
    m[3][2] = static_cast<float>(nearPlane * farPlane / (nearPlane - farPlane));
    return m;
}

glm::mat4 perspectiveGl(double fieldOfView, double aspect, double nearPlane, double farPlane) {
    const double top = nearPlane * tangent(fieldOfView / 2);
    return frustumGl(-top * aspect, top * aspect, -top, top, nearPlane, farPlane);
}

glm::mat4 frustumGl(double left, double right, double bottom, double top, double nearPlane, double farPlane) {
    glm::mat4 m(0);
    m[0][0] = static_cast<float>(2 * nearPlane / (right - left));
    m[1][1] = static_cast<float>(2 * nearPlane / (top - bottom));
    m[2][0] = static_cast<float>((right + left) / (right - left));
    m[2][1] = static_cast<float>((top + bottom) / (top - bottom));
    m[2][2] = static_cast<float>((nearPlane + farPlane) / (nearPlane - farPlane));
    m[2][3] = -1;
    m[3][2] = static_cast<float>(2 * nearPlane * farPlane / (nearPlane - farPlane));
    return m;
}

glm::mat4 orthographic(float left, float right, float bottom, float top, float nearPlane, float farPlane) {
    glm::mat4 m(1);
    m[0][0] = 2 / (right - left);
    m[1][1] = -2 / (top - bottom);
    m[2][2] = 1 / (nearPlane - farPlane);
    m[3] = glm::vec4((right + left) / (left - right), (top + bottom) / (top - bottom),
                     nearPlane / (nearPlane - farPlane), 1);
    return m;
}

glm::mat4 rotation(double angle, const glm::vec3& axis) {
    const float c = cosineF(angle), s = sineF(angle);
    const glm::vec3 a = glm::normalize(axis), t = a * (1 - c);
    return glm::mat4(glm::vec4(t.x * a.x + c, t.x * a.y + s * a.z, t.x * a.z - s * a.y, 0),
                     glm::vec4(t.y * a.x - s * a.z, t.y * a.y + c, t.y * a.z + s * a.x, 0),
                     glm::vec4(t.z * a.x + s * a.y, t.z * a.y - s * a.x, t.z * a.z + c, 0), glm::vec4(0, 0, 0, 1));
}

}  // namespace samples
