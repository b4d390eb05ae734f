#include "samples/viewer/dial.h"

namespace samples {

Dial::Dial() {
    VnAxisInfo info{};
    for (uint32_t index = 0; vnGetAxis(index, &info) == VN_SUCCESS; ++index) {
        Axis axis;
        axis.name = info.name;
        axis.meaning = info.meaning;
        axis.choices.emplace_back("profile");
        for (uint32_t i = 0; i < info.positionCount; ++i) axis.choices.emplace_back(info.positions[i]);
        axis.lowestForVulkan = info.lowestForVulkan;
        axes_.push_back(axis);
    }
}

std::vector<Option> Dial::options() {
    std::vector<Option> options{{"--profile", "position of the dial", &profile_, 'p', profileNames_}};
    char key = '1';
    for (Axis& axis : axes_)
        options.push_back({"--" + axis.name, "axis of the dial: " + axis.meaning, &axis.chosen, key++, axis.choices});
    return options;
}

DialPosition Dial::position() const {
    DialPosition position;
    position.profile = static_cast<VnProfile>(VN_PROFILE_DRAFT + profile_);
    for (const Axis& axis : axes_)
        if (axis.chosen > 0)
            position.axes +=
                (position.axes.empty() ? "" : " ") + axis.name + "=" + axis.choices[static_cast<size_t>(axis.chosen)];
    return position;
}

std::string Dial::text() const {
    std::string text = profileNames_[static_cast<size_t>(profile_)];
    for (const Axis& axis : axes_)
        if (axis.chosen > 0) text += ", " + axis.name + " " + axis.choices[static_cast<size_t>(axis.chosen)];
    return text;
}

const std::string& Dial::positionOf(const Axis& axis) const {
    if (axis.chosen > 0) return axis.choices[static_cast<size_t>(axis.chosen)];
    uint32_t position = 0;
    vnGetAxisPosition(static_cast<uint32_t>(&axis - axes_.data()), this->position().profile, &position);
    return axis.choices[position + 1];
}

}  // namespace samples
