#include "samples/viewer/ui.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>

namespace samples {
namespace {

/// ImGui's default letters are 13 pixels high, made for that height.
constexpr float kLetter = 13;

bool combo(const char* label, int& chosen, const std::vector<std::string>& names) {
    const auto nameOf = [](void* data, int index, const char** text) {
        *text = (*static_cast<const std::vector<std::string>*>(data))[static_cast<size_t>(index)].c_str();
        return true;
    };
    return ImGui::Combo(label, &chosen, nameOf, const_cast<std::vector<std::string>*>(&names),
                        static_cast<int>(names.size()));
}

void sceneSection(const Scene& scene) {
    ImGui::Text("%s: %zu triangles, %zu parts", scene.name.c_str(), triangleCount(scene), scene.parts.size());
    for (const std::string& note : scene.notes) ImGui::TextWrapped("- %s", note.c_str());
}

void dialSection(Dial& dial) {
    combo("profile", dial.profile(), dial.profileNames());
    for (Dial::Axis& axis : dial.axes()) {
        combo(axis.name.c_str(), axis.chosen, axis.choices);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", axis.meaning.c_str());
        if (axis.chosen == 0) {
            ImGui::SameLine();
            ImGui::TextDisabled("%s", dial.positionOf(axis).c_str());
        }
    }
}

void viewSection(ViewSettings& view, CameraSettings& camera, const ViewReport& report) {
    for (const Option& option : viewOptions(view))
        if (!option.choices.empty()) combo(option.name.c_str() + 2, *std::get<int*>(option.target), option.choices);
    if (view.kind() == ViewKind::kSplit) {
        auto divide = static_cast<float>(view.divide);
        if (ImGui::SliderFloat("divide", &divide, 0, 1)) view.divide = double{divide};
    }
    if (report.scale > 0) {
        auto scale = static_cast<float>(report.scale);
        if (ImGui::DragFloat("scale", &scale, scale * 0.01f, 1e-6f, 1e6f, "%g")) view.scale = double{scale};
    }
    ImGui::Checkbox("edges", &view.edges);
    ImGui::SameLine();
    bool fly = camera.fly != 0;
    if (ImGui::Checkbox("fly", &fly)) camera.fly = fly;
    ImGui::SameLine();
    ImGui::Checkbox("explain", &view.explain);
}

void measuredSection(const UiModel& model) {
    const VnStatistics& counted = model.report.statistics;
    const auto line = [](const char* what, uint64_t count) {
        ImGui::Text("%-22s %12llu", what, static_cast<unsigned long long>(count));
    };
    line("vertex runs", counted.vertexInvocations);
    line("triangles drawn", counted.rasterPrimitives);
    line("fragment runs", counted.fragmentInvocations);
    line("helper runs", counted.helperInvocations);
    line("colours read back", counted.destinationReads);
    if (model.times.empty()) return;
    char text[48];
    std::snprintf(text, sizeof text, "%.2f ms, %.0f frames/s", model.times.mean(), 1000 / model.times.mean());
    ImGui::PlotLines("##times", model.times.values(), model.times.count(), model.times.first(), text, 0, FLT_MAX,
                     ImVec2(ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight() * 4));
}

}  // namespace

void FrameTimes::add(double milliseconds) {
    values_[next_] = static_cast<float>(milliseconds);
    next_ = (next_ + 1) % kCount;
    count_ = std::min(count_ + 1, kCount);
}

double FrameTimes::mean() const {
    double sum = 0;
    for (int i = 0; i < count_; ++i) sum += double{values_[i]};
    return sum / count_;
}

Ui::Ui(App& app, float scale) : app_(app), unit_(kLetter * scale), imgui_(app, unit_) {}

UiActions Ui::panel(const UiModel& model) {
    UiActions actions;
    const float width = std::min(unit_ * 25, static_cast<float>(app_.width()));
    ImGui::SetNextWindowPos(ImVec2(static_cast<float>(app_.width()) - width, 0));
    ImGui::SetNextWindowSize(ImVec2(width, static_cast<float>(app_.height())));
    ImGui::Begin("Vernier", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoTitleBar);
    ImGui::PushItemWidth(unit_ * 11);
    sceneSection(model.scene);
    ImGui::Separator();
    dialSection(model.dial);
    ImGui::Separator();
    viewSection(model.view, model.camera, model.report);
    ImGui::Separator();
    measuredSection(model);
    ImGui::Separator();
    actions.screenshot = ImGui::Button("screenshot");
    ImGui::SameLine();
    actions.turntable = ImGui::Button("turntable");
    ImGui::SameLine();
    ImGui::TextDisabled("F1: keys");
    if (!model.message.empty()) ImGui::TextWrapped("%s", model.message.c_str());
    if (model.view.explain) {
        ImGui::BeginChild("explain", ImVec2(0, 0), true);
        ImGui::TextWrapped("%s", model.report.explanation.c_str());
        ImGui::EndChild();
    }
    ImGui::PopItemWidth();
    ImGui::End();
    return actions;
}

void Ui::help(const UiModel& model) {
    ImGui::SetNextWindowPos(ImVec2(unit_ * 2, unit_ * 2));
    ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
    ImGui::TextUnformatted(model.keys.c_str());
    ImGui::End();
}

void Ui::legend(const std::vector<LegendText>& texts) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const LegendText& text : texts) {
        const float width = text.end ? ImGui::CalcTextSize(text.text.c_str()).x : 0;
        // Whole pixels, so that letters stay sharp; a shadow, so that they can be read on any colour.
        const ImVec2 place(std::floor(text.place.x - width), std::floor(text.place.y));
        list.AddText(ImVec2(place.x + 1, place.y + 1), IM_COL32(0, 0, 0, 255), text.text.c_str());
        list.AddText(place, IM_COL32(255, 255, 255, 255), text.text.c_str());
    }
}

}  // namespace samples
