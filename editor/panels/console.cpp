// Messages of the level, a run, and the editor.
#include <fmt/format.h>

#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

const char* word_of(Severity severity) {
  return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "";
}

std::string text_of(const Said& said) {
  return printable(said.text) + (said.times > 1 ? fmt::format("  ({} times)", said.times) : "");
}

class ConsolePanel : public Panel {
 public:
  explicit ConsolePanel(App& app) : app_(app) {}
  const char* name() const override { return "Console"; }
  Place place() const override { return Place::kBottom; }

  void draw(Editor& editor) override {
    filters(editor);
    ImGui::BeginChild("lines", {0, 0});
    const ui::Palette& p = ui::palette();
    for (const Said& said : editor.said) {
      if (!is_shown(said)) continue;
      const char* const word = word_of(said.severity);
      ImGui::PushFont(ui::font(ui::Type::kSmall));
      ImGui::TextColored(p.faint, "%s", fmt::format("{:7.1f} s", said.time).c_str());
      ImGui::PopFont();
      ImGui::SameLine();
      if (*word) {
        ImGui::TextColored(said.severity == Severity::kError ? p.bad : p.warning, "%s", word);
        ImGui::SameLine();
      }
      ImGui::PushTextWrapPos(0);
      ImGui::TextUnformatted(text_of(said).c_str());
      ImGui::PopTextWrapPos();
    }
    if (editor.said.size() != shown_) ImGui::SetScrollHereY(1.0f);
    shown_ = editor.said.size();
    ImGui::EndChild();
  }

 private:
  bool is_shown(const Said& said) const {
    return said.severity == Severity::kError ? errors_ : said.severity == Severity::kWarning ? warnings_ : notes_;
  }

  void filters(Editor& editor) {
    ui::checkbox("Errors", errors_);
    ImGui::SameLine();
    ui::checkbox("Warnings", warnings_);
    ImGui::SameLine();
    ui::checkbox("Notes", notes_);
    // In a small window they form a separate row.
    if (const float at = ImGui::GetWindowContentRegionMax().x - ui::px(148);
        ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x <= at)
      ImGui::SameLine(at);
    if (ui::button("Copy", "The lines that are shown, to the clipboard", !editor.said.empty(), 70)) {
      std::string all;
      for (const Said& said : editor.said)
        if (is_shown(said))
          all += fmt::format("{:.1f} s  {}{}{}\n", said.time, word_of(said.severity),
                             *word_of(said.severity) ? ": " : "", text_of(said));
      app_.window().set_clipboard(all);
    }
    ImGui::SameLine();
    if (ui::button("Clear", nullptr, !editor.said.empty(), 70)) editor.said.clear();
  }

  App& app_;
  std::size_t shown_ = 0;
  bool errors_ = true, warnings_ = true, notes_ = true;
};

}  // namespace

std::unique_ptr<Panel> make_console_panel(App& app) {
  return std::make_unique<ConsolePanel>(app);
}

}  // namespace pliant
