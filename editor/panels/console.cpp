// What has been said: by the level, by a run, by the editor itself.
#include <fmt/format.h>

#include "editor/panels/panels.h"
#include "editor/ui/widgets.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

class ConsolePanel : public Panel {
 public:
  const char* name() const override { return "Console"; }
  Place place() const override { return Place::kBottom; }

  void draw(Editor& editor) override {
    ImGui::BeginChild("lines", {0, 0});
    const ui::Palette& p = ui::palette();
    for (const Said& said : editor.said) {
      const char* word = said.severity == Severity::kError     ? "error"
                         : said.severity == Severity::kWarning ? "warning"
                                                               : "";
      ImGui::PushFont(ui::font(ui::Type::kSmall));
      ImGui::TextColored(p.faint, "%s", fmt::format("{:7.1f} s", said.time).c_str());
      ImGui::PopFont();
      ImGui::SameLine();
      if (*word) {
        ImGui::TextColored(said.severity == Severity::kError ? p.bad : p.warning, "%s", word);
        ImGui::SameLine();
      }
      ImGui::PushTextWrapPos(0);
      const std::string text = printable(said.text) + (said.times > 1 ? fmt::format("  ({} times)", said.times) : "");
      ImGui::TextUnformatted(text.c_str());
      ImGui::PopTextWrapPos();
    }
    if (editor.said.size() != shown_) ImGui::SetScrollHereY(1.0f);
    shown_ = editor.said.size();
    ImGui::EndChild();
  }

 private:
  std::size_t shown_ = 0;
};

}  // namespace

std::unique_ptr<Panel> make_console_panel() {
  return std::make_unique<ConsolePanel>();
}

}  // namespace pliant
