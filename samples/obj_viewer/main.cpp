// Shows a Wavefront OBJ file with half-Lambert light: obj_viewer [FILE.obj]. Without a file it shows a torus knot of
// its own. Normals are computed where the file has none. Drag turns, the wheel comes nearer.
#include "samples/common/app.h"
#include "samples/common/camera.h"
#include "samples/common/obj_file.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldNormal;
void main() {
    worldNormal = mat3(model) * normal;
    gl_Position = transform * vec4(position, 1);
})";

// Half-Lambert: the cosine is moved from -1..1 to 0..1 and squared, so that the side turned away is not flat.
constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec3 worldNormal;
layout(location = 0) out vec4 color;
void main() {
    float cosine = dot(normalize(worldNormal), normalize(vec3(0.5, 0.8, 0.6)));
    float light = cosine * 0.5 + 0.5;
    color = vec4(vec3(0.9, 0.75, 0.55) * light * light + 0.02, 1);
})";

}  // namespace

int main(int argc, char** argv) {
    std::string file;
    samples::App app(argc, argv, "OBJ viewer", {{"file", "an OBJ file; without: a torus knot", &file}});
    samples::MeshData data = file.empty() ? samples::torusKnotMesh() : samples::loadObj(file);
    samples::fitIntoUnitBall(data);
    const samples::Mesh mesh = app.mesh(data);
    const VnProgram program = app.program(kVertex, kFragment);
    const VnVertexLayout layout = app.meshLayout();
    const VnDepthStencilState depth = app.depthState();
    samples::OrbitCamera camera({0, 0, 0}, 2.3f, 0, -0.2);

    return app.run({0.04f, 0.05f, 0.07f, 1}, [&](const samples::Frame& frame) {
        camera.update(frame.input);
        struct {
            glm::mat4 transform, model;
        } push;
        push.model = samples::rotation(frame.seconds * 0.7, {0, 1, 0});
        push.transform = samples::perspective(0.9, app.aspect(), 0.1, 20) * camera.view() * push.model;
        VnContext context = app.context();
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindDepthStencilState(context, depth);
        app.push(push);
        app.draw(mesh);
    });
}
