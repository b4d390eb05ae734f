// What runs a Scene: one class per API that can draw it.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vernier::conformance {

/// How long one scene took, in milliseconds of wall time.
struct Timing {
    double startUp = 0;     // finding the driver and creating its device
    double modules = 0;     // creating the shader modules, where the API has them
    double pipelines = 0;   // creating the pipelines
    double firstFrame = 0;  // the first run of the recorded commands
    double warmFrame = 0;   // a later run of what firstFrame ran
    double firstImage = 0;  // from before start-up until the scene's pixels are in host memory
    double frame = 0;       // the median of `frames` further runs of the recorded commands
    uint32_t frames = 0;

    /// From modules to a first result, less what every later run takes.
    double toFirstResult() const { return pipelines + firstFrame - warmFrame; }
};

class Driver {
  public:
    virtual ~Driver() = default;

    /// The implementation as it names itself.
    virtual std::string name() const = 0;
    virtual std::string version() const = 0;
    /// The limits that bear on pixels (sub-pixel bits, filter precision, ...), one "name value" a line.
    virtual std::string limits() const = 0;
    /// The sub-pixel bits that the implementation declares.
    virtual uint32_t subPixelBits() const = 0;

    /// Runs the scene and returns one image per Scene::outputs. `timing` may be nullptr: then the commands
    /// run once only. A scene that needs what the implementation lacks is an `unsupported` error that names
    /// it.
    virtual Result<std::vector<RenderedImage>> render(const Scene& scene, Timing* timing) = 0;

    /// What the scene rendered last with a timing did not need, "what: why" each. Empty where the implementation does
    /// not say.
    virtual std::vector<std::string> notNeeded() const { return {}; }
};

/// Checks what both kinds of driver rely on: indices in range, formats known, data sizes fitting. The error
/// names the object, the field and the value.
Status validateScene(const Scene& scene);

}  // namespace vernier::conformance
