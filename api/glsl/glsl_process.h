// The life of glslang's process-wide tables.
#pragma once

namespace vernier::glsl {

/// Adds a reference to glslang's process-wide state, setting it up with the first one. False if that fails.
bool retainProcess();

/// Drops a reference; the last one tears the state down. Returns false, and does nothing, when there is none.
bool releaseProcess();

/// A reference held for a scope.
class ProcessReference {
  public:
    ProcessReference() : valid_(retainProcess()) {}
    ~ProcessReference() {
        if (valid_) releaseProcess();
    }
    ProcessReference(const ProcessReference&) = delete;
    ProcessReference& operator=(const ProcessReference&) = delete;

    bool valid() const { return valid_; }

  private:
    bool valid_;
};

}  // namespace vernier::glsl
