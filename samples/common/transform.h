// Matrices of the samples: GLM's types (column vectors, column-major, right-handed worlds with y up), made without the
// C library's sine (see trigonometry.h). glm::lookAt, translate and scale need none and are used as they are.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace samples {

/// A perspective with depth 0..1 and y down, as Vulkan and Vernier have it; `fieldOfView` vertical, in radians.
glm::mat4 perspective(double fieldOfView, double aspect, double nearPlane, double farPlane);

/// The same with depth -1..1 and y up: OpenGL's clip space, for VnRasterStateDesc::depthNegativeOneToOne and a viewport
/// of negative height.
glm::mat4 perspectiveGl(double fieldOfView, double aspect, double nearPlane, double farPlane);

/// glFrustum.
glm::mat4 frustumGl(double left, double right, double bottom, double top, double nearPlane, double farPlane);

/// Parallel rays, depth 0..1, y down: what glOrtho is to frustumGl.
glm::mat4 orthographic(float left, float right, float bottom, float top, float nearPlane, float farPlane);

/// By `angle` radians, counter-clockwise seen from where `axis` points.
glm::mat4 rotation(double angle, const glm::vec3& axis);

}  // namespace samples
