#include "samples/viewer/gltf_animation.h"

#include <algorithm>

#include "samples/viewer/gltf_accessor.h"

namespace samples {
namespace {

glm::vec3 vec3Of(const std::vector<double>& values, const glm::vec3& otherwise) {
    return values.size() == 3 ? glm::vec3(values[0], values[1], values[2]) : otherwise;
}

/// Between two directions in four dimensions, along the arc (glTF 2.0, appendix C.4). The middle of an arc is the sum
/// of its ends: after so many halvings the chord is as good. The arc cosine of a library would not be the same
/// everywhere.
glm::vec4 alongArc(glm::vec4 a, glm::vec4 b, float t) {
    if (glm::dot(a, b) < 0) b = -b;
    for (int i = 0; i < 8; ++i) {
        const glm::vec4 middle = glm::normalize(a + b);
        t *= 2;
        if (t < 1) {
            b = middle;
        } else {
            a = middle;
            t -= 1;
        }
    }
    return glm::normalize(a + (b - a) * t);
}

}  // namespace

glm::mat4 NodePlace::local() const {
    if (isMatrix) return matrix;
    return glm::scale(glm::translate(glm::mat4(1), translation) * glm::mat4_cast(rotation), scale);
}

NodePlace placeOf(const tinygltf::Node& node) {
    NodePlace place;
    if (node.matrix.size() == 16) {
        place.isMatrix = true;
        for (int i = 0; i < 16; ++i)
            place.matrix[i / 4][i % 4] = static_cast<float>(node.matrix[static_cast<size_t>(i)]);
        return place;
    }
    place.translation = vec3Of(node.translation, glm::vec3(0));
    if (const auto& r = node.rotation; r.size() == 4)
        place.rotation = glm::quat(static_cast<float>(r[3]), static_cast<float>(r[0]), static_cast<float>(r[1]),
                                   static_cast<float>(r[2]));
    place.scale = vec3Of(node.scale, glm::vec3(1));
    return place;
}

bool GltfAnimation::readKeys(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler, Channel& channel,
                             std::string& error) {
    const int width = channel.path == Path::kRotation ? 4 : 3;
    if (!readFloats(model, sampler.input, 1, channel.times, error) ||
        !readFloats(model, sampler.output, width, channel.values, error))
        return false;
    if (sampler.interpolation == "STEP") channel.way = Way::kStep;
    if (sampler.interpolation == "CUBICSPLINE") channel.way = Way::kCubic;
    const size_t perKey = static_cast<size_t>(width) * (channel.way == Way::kCubic ? 3 : 1);
    if (channel.values.size() / perKey != channel.times.size()) {
        error = std::to_string(channel.times.size()) + " keys, but values for " +
                std::to_string(channel.values.size() / perKey);
        return false;
    }
    float before = 0;
    for (const float time : channel.times) {
        if (!(time >= before && time < 1e6f)) {
            error = "the times of its keys do not rise";
            return false;
        }
        before = time;
    }
    return true;
}

bool GltfAnimation::read(const tinygltf::Model& model, const tinygltf::Animation& animation, bool& morphs,
                         std::string& error) {
    for (const tinygltf::AnimationChannel& from : animation.channels) {
        if (from.target_path == "weights") {
            morphs = true;
            continue;
        }
        Channel channel;
        if (from.target_node < 0) continue;  // "SHOULD be ignored"
        channel.node = static_cast<size_t>(from.target_node);
        if (channel.node >= model.nodes.size()) {
            error = "there is no node " + std::to_string(from.target_node);
            return false;
        }
        if (from.target_path == "rotation") {
            channel.path = Path::kRotation;
        } else if (from.target_path == "scale") {
            channel.path = Path::kScale;
        } else if (from.target_path != "translation") {
            error = "moves \"" + from.target_path + "\"";
            return false;
        }
        if (from.sampler < 0 || static_cast<size_t>(from.sampler) >= animation.samplers.size()) {
            error = "there is no sampler " + std::to_string(from.sampler);
            return false;
        }
        if (!readKeys(model, animation.samplers[static_cast<size_t>(from.sampler)], channel, error)) return false;
        seconds_ = std::max(seconds_, double{channel.times.back()});
        channels_.push_back(std::move(channel));
    }
    return true;
}

glm::vec4 GltfAnimation::valueAt(const Channel& channel, float seconds) {
    const std::vector<float>& times = channel.times;
    const auto after = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
    const size_t b = std::min(after, times.size() - 1), a = after == 0 ? 0 : after - 1;
    const size_t width = channel.path == Path::kRotation ? 4 : 3;
    const bool cubic = channel.way == Way::kCubic;
    // Of the three values of a key of a spline: 0 the tangent before it, 1 itself, 2 the tangent behind.
    const auto value = [&](size_t key, size_t which) {
        glm::vec4 result(0);
        const size_t first = (cubic ? key * 3 + which : key) * width;
        for (size_t c = 0; c < width; ++c) result[static_cast<int>(c)] = channel.values[first + c];
        return result;
    };
    const float length = times[b] - times[a];
    if (a == b || channel.way == Way::kStep || !(length > 0)) return value(a, 1);
    const float t = (seconds - times[a]) / length;
    if (cubic) {
        // glTF 2.0, appendix C.5.
        const float t2 = t * t, t3 = t2 * t;
        const glm::vec4 result = value(a, 1) * (2 * t3 - 3 * t2 + 1) + value(a, 2) * (length * (t3 - 2 * t2 + t)) +
                                 value(b, 1) * (3 * t2 - 2 * t3) + value(b, 0) * (length * (t3 - t2));
        return channel.path == Path::kRotation ? glm::normalize(result) : result;
    }
    if (channel.path == Path::kRotation) return alongArc(value(a, 1), value(b, 1), t);
    return value(a, 1) + (value(b, 1) - value(a, 1)) * t;
}

void GltfAnimation::apply(double seconds, std::vector<NodePlace>& places) const {
    for (const Channel& channel : channels_) {
        const glm::vec4 value = valueAt(channel, static_cast<float>(seconds));
        NodePlace& place = places[channel.node];
        if (channel.path == Path::kTranslation) place.translation = glm::vec3(value);
        if (channel.path == Path::kScale) place.scale = glm::vec3(value);
        if (channel.path == Path::kRotation) place.rotation = glm::quat(value.w, value.x, value.y, value.z);
    }
}

}  // namespace samples
