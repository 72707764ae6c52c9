// The bars above and below the panels, and the message over the viewport.
#include <fmt/format.h>

#include <algorithm>

#include "editor/app/app.h"
#include "editor/app/files.h"
#include "editor/app/fixed_window.h"
#include "editor/app/layout.h"
#include "runtime/printable.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kTopPad = 9;  // [point] above the buttons of the top bar
constexpr double kToastSeconds = 6.0;

}  // namespace

float App::tools_width(bool signs) const {
  const ImGuiStyle& style = ImGui::GetStyle();
  float wide = 0;
  for (const auto& each : tools_)
    wide += ImGui::CalcTextSize(signs ? each->sign() : each->name()).x + 2 * style.FramePadding.x + ui::px(2);
  return wide + ui::px(ui::kWide) + 5 * (ImGui::GetFrameHeight() + ui::px(8));  // play buttons
}

bool App::top_has_two_rows() const {
  const ImGuiStyle& style = ImGui::GetStyle();
  float wide = ImGui::CalcTextSize("SolidRendered").x + 4 * style.FramePadding.x + ui::px(2 * ui::kPad + 3 * ui::kWide);
  std::string before;
  for (const Action& action : actions_)
    if (action.group != before)
      wide += ImGui::CalcTextSize((before = action.group).c_str()).x + 2 * style.FramePadding.x + ui::px(2);
  return wide + tools_width(false) > ImGui::GetIO().DisplaySize.x;
}

void App::draw_top(float high) {
  const ui::Palette& p = ui::palette();
  const float all = ImGui::GetIO().DisplaySize.x;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kPad), ui::px(kTopPad)));
  begin_fixed("top", {0, 0}, {all, high}, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  draw_menus();
  float used = ImGui::GetCursorPosX();
  const bool two_rows = top_has_two_rows();
  const auto tools = [&] {
    {
      const ui::Scope scope("Tools");
      const bool signs = tools_width(false) + ui::px(2 * ui::kPad) > all;
      for (const auto& each : tools_) {
        const std::string shown = std::string(signs ? each->sign() : each->name()) + "###" + each->name();
        if (ui::choice_button(shown.c_str(), tool() == each.get(), each->hint(), each->usable(editor)))
          take_tool(each->name());
        ui::known_as(each->name());
        ImGui::SameLine(0, ui::px(2));
      }
    }
    ImGui::SameLine(0, ui::px(ui::kWide));
    draw_play_buttons();
  };
  if (!two_rows) {  // viewport tools, after the menus
    ImGui::SameLine(0, ui::px(ui::kWide));
    tools();
    ImGui::SameLine();
    used = ImGui::GetCursorPosX();
  }
  // The document's title in the centre of the remaining space; view modes at the right.
  const float buttons =
      ImGui::CalcTextSize("SolidRendered").x + 4 * ImGui::GetStyle().FramePadding.x + ui::px(2 + ui::kPad);
  const std::string title = printable(editor.document.title()) + (files_->read_only() ? " (read-only)" : "") +
                            (editor.document.dirty() ? "  \u2022" : "");
  const float room = all - buttons - ui::px(ui::kWide) - used;
  if (ImGui::CalcTextSize(title.c_str()).x < room) {
    ImGui::SameLine(all - buttons - ui::px(ui::kWide) - ImGui::CalcTextSize(title.c_str()).x);
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, editor.document.dirty() ? p.text : p.dim);
    ImGui::TextUnformatted(title.c_str());
    ImGui::PopStyleColor();
    ui::hint(editor.document.file().empty() ? "This level has no file yet."
                                            : printable(editor.document.file().string()).c_str());
  }
  ImGui::SameLine(all - buttons);
  draw_view_mode();
  if (two_rows) {
    ImGui::SetCursorPos({ui::px(ui::kPad), ui::px(kTopPad + kTopRow)});
    tools();
  }
  ImGui::End();
}

void App::draw_view_mode() {
  const ui::Scope scope("View mode");
  const bool rendered = editor.view.shading == Shading::kRendered;
  if (ui::choice_button("Solid", !rendered, "The level as it is edited, with painted values as colour")) {
    editor.view.shading = Shading::kSolid;
    dirty_picture_ = true;
  }
  ImGui::SameLine(0, ui::px(2));
  if (ui::choice_button("Rendered", rendered, "The level as it is played: materials, surroundings, shadows")) {
    editor.view.shading = Shading::kRendered;
    dirty_picture_ = true;
  }
}

void App::draw_bottom_bar() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ui::Palette& p = ui::palette();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kPad), ui::px(4)));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, p.window);
  begin_fixed("bar", {0, size.y - ui::px(kBottomBar)}, size, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  const std::vector<std::string> under_way = editor.jobs.under_way();
  std::string left = under_way.empty() ? (tool() ? tool()->hint() : "") : under_way.front() + " \u2026";
  if (!editor.said.empty() && editor.now - editor.said.back().time < kToastSeconds && under_way.empty())
    left = editor.said.back().text;
  ImGui::PushStyleColor(ImGuiCol_Text, p.dim);
  ImGui::TextUnformatted(printable(left).c_str());
  const std::string right =
      fmt::format("{} node{}   {:L} triangles   picture {:.0f} ms{}   interface {:.0f} ms", editor.state().nodes.size(),
                  editor.state().nodes.size() == 1 ? "" : "s", picture_.triangles, picture_.draw_ms,
                  picture_.share < 1.0 ? fmt::format(" at {:.0f} %", 100 * picture_.share) : "", frame_ms_);
  ImGui::SameLine(size.x - ImGui::CalcTextSize(right.c_str()).x - ui::px(ui::kPad));
  ImGui::TextUnformatted(right.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::End();
}

// An error stays visible until it has been read.
void App::draw_toasts() {
  if (editor.said.empty()) return;
  const Said& last = editor.said.back();
  if (last.severity == Severity::kNote || editor.now - last.time > 2 * kToastSeconds) return;
  const ui::Palette& p = ui::palette();
  const bool error = last.severity == Severity::kError;
  ImGui::SetNextWindowPos({0.5f * (viewport_low_.x + viewport_high_.x), viewport_high_.y - ui::px(ui::kPad)},
                          ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.8f * (viewport_high_.x - viewport_low_.x), ui::px(200)});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, p.raised);
  ImGui::Begin("said", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos(0.75f * (viewport_high_.x - viewport_low_.x));
  ImGui::PushStyleColor(ImGuiCol_Text, error ? p.bad : p.warning);
  ImGui::TextUnformatted(error ? "Error" : "Warning");
  ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::TextUnformatted(printable(last.text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace pliant
