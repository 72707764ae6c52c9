// All steps, including undone ones; a click goes to that step.
#include <fmt/format.h>

#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

class HistoryPanel : public Panel {
 public:
  const char* name() const override { return "History"; }
  Place place() const override { return Place::kBottom; }

  void draw(Editor& editor) override {
    const Document& document = editor.document;
    ui::gap(2);
    ui::dim("Click a step to go there. What comes after it stays until something new is done.");
    ui::gap(2);
    ImGui::BeginChild("steps");
    std::optional<std::size_t> wanted;
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(document.step_count()));
    while (clipper.Step())
      for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
        const auto i = static_cast<std::size_t>(row);
        const bool undone = i > document.step();
        if (undone) ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().faint);
        const std::string what = i == 0 ? "As it was opened" : printable(document.step_what(i));
        if (ui::selectable(fmt::format("{}{}##{}", what, undone ? "  (undone)" : "", i).c_str(), i == document.step()))
          wanted = i;
        ui::known_as(fmt::format("step {}", i));
        if (undone) ImGui::PopStyleColor();
      }
    if (document.step() != shown_) {
      const float line = ImGui::GetTextLineHeightWithSpacing();
      ImGui::SetScrollY(static_cast<float>(document.step()) * line - 0.5f * ImGui::GetWindowHeight());
      shown_ = document.step();
    }
    ImGui::EndChild();
    if (wanted) editor.go_to_step(*wanted);
  }

 private:
  std::size_t shown_ = 0;
};

}  // namespace

std::unique_ptr<Panel> make_history_panel() {
  return std::make_unique<HistoryPanel>();
}

}  // namespace pliant
