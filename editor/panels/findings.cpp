// Faults of the current level, and their remedies.
#include "editor/app/findings.h"

#include <fmt/format.h>

#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

class FindingsPanel : public Panel {
 public:
  const char* name() const override { return "Findings"; }
  Place place() const override { return Place::kBottom; }
  std::string badge(const Editor& editor) const override {
    std::size_t count = 0;
    for (const auto* const list : {&editor.findings, &editor.run_findings})
      for (const EditorFinding& each : *list) count += each.finding.severity != Severity::kNote;
    return count == 0 ? "" : fmt::format("{}", count);
  }

  void draw(Editor& editor) override {
    watch_line(editor);
    ImGui::BeginChild("list");
    const EditorFinding* fixed = nullptr;
    std::size_t number = 0;
    for (const auto* const list : {&editor.findings, &editor.run_findings})
      for (const EditorFinding& each : *list)
        if (row(editor, each, number++)) fixed = &each;
    if (fixed) {
      const QuickFix fix = *fixed->fix;
      editor.apply(fix.label, fix.fix(editor.state(), editor.document.next_id()));
    }
    ImGui::EndChild();
  }

 private:
  static void watch_line(const Editor& editor) {
    std::size_t count[3]{};
    for (const auto* const list : {&editor.findings, &editor.run_findings})
      for (const EditorFinding& each : *list) ++count[static_cast<std::size_t>(each.finding.severity)];
    const bool nothing = editor.findings.empty() && editor.run_findings.empty();
    const bool current = editor.found_at == editor.document.revision();
    std::string text = editor.playing && !current ? "Checked again when the run has ended"
                       : !current                 ? "Checking \u2026"
                       : nothing                  ? "Nothing is wrong"
                                                  : "";
    const auto add = [&](std::size_t n, const char* one, const char* many) {
      if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : "   ", n, n == 1 ? one : many);
    };
    add(count[0], "error", "errors");
    add(count[1], "warning", "warnings");
    add(count[2], "note", "notes");
    ui::dim(text.c_str());
    if (current) ui::known_as(nothing ? "Nothing is wrong" : "Checked");
  }

  // True: its fix was requested.
  bool row(Editor& editor, const EditorFinding& found, std::size_t i) {
    const ui::Palette& p = ui::palette();
    const Severity severity = found.finding.severity;
    const char* const word = severity == Severity::kError     ? "Error"
                             : severity == Severity::kWarning ? "Warning"
                                                              : "Note";
    const ImVec4& tint = severity == Severity::kError ? p.bad : severity == Severity::kWarning ? p.warning : p.dim;
    const DocumentNode* const node = editor.state().find(found.node);
    const ui::Scope scope(fmt::format("{}", i + 1));
    ImGui::PushID(static_cast<int>(i));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float wide = ImGui::GetContentRegionAvail().x, column = ui::px(84);
    const float fix_wide = found.fix ? ImGui::CalcTextSize(found.fix->label.c_str()).x + ui::px(2 * ui::kPad) : 0.0f;
    const std::string text =
        (node ? printable(node->node.name) + " " : std::string()) + printable(found.finding.message());
    const float wrap = std::max(wide - column - fix_wide - ui::px(ui::kWide), ui::px(120));
    const float high = std::max(ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).y, ImGui::GetFrameHeight());
    if (ImGui::Selectable("##row", node && editor.is_selected(node->id), ImGuiSelectableFlags_AllowItemOverlap,
                          {0, high + ui::px(2)}) &&
        node) {
      editor.select(node->id);
      editor.frame_selected();
    }
    ui::known_as("row");
    ui::hint(node ? "Selects the node and brings it into view" : found.finding.pointer.c_str());
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float line = ImGui::GetTextLineHeight(), middle = at.y + 0.5f * line + ui::px(2);
    sign(list, {at.x + ui::px(10), middle}, severity, ui::color(tint));
    list.AddText({at.x + ui::px(22), at.y + ui::px(2)}, ui::color(tint), word);
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {at.x + column, at.y + ui::px(2)}, ui::color(p.text),
                 text.c_str(), nullptr, wrap);
    bool fix = false;
    if (found.fix) {
      ImGui::SetCursorScreenPos({at.x + wide - fix_wide, at.y});
      fix = ui::button(fmt::format("{}##fix", found.fix->label).c_str(), "Mends it; undo takes it back");
      ui::known_as(found.fix->label);
    }
    ImGui::SetCursorScreenPos(after);
    ImGui::PopID();
    return fix;
  }

  // A different shape for each, because colour alone is not enough.
  static void sign(ImDrawList& list, ImVec2 c, Severity severity, ImU32 tint) {
    const float r = ui::px(5);
    if (severity == Severity::kError) {
      list.AddCircleFilled(c, r, tint);
    } else if (severity == Severity::kWarning) {
      list.AddTriangleFilled({c.x, c.y - r}, {c.x - r, c.y + 0.8f * r}, {c.x + r, c.y + 0.8f * r}, tint);
    } else {
      list.AddCircle(c, 0.8f * r, tint, 0, ui::px(1.5f));
    }
  }
};

}  // namespace

std::unique_ptr<Panel> make_findings_panel() {
  return std::make_unique<FindingsPanel>();
}

}  // namespace pliant
