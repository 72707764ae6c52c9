#include "player/window/side_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "player/window/overlay.h"
#include "runtime/printable.h"
#include "viewer/ui/imgui_pen.h"

namespace pliant {
namespace {

const ImVec4 kLawColor(1.0f, 0.62f, 0.34f, 1.0f);
constexpr float kLoopHeight = 96.0f,
                kRoomForLoop = 400.0f;  // [point] of the plot, and of the window that has room for it

// A slider of several decades is logarithmic.
constexpr double kDecades = 100.0;

void draw_slider(const PanelSlider& slider, std::size_t number, PanelOrders& orders) {
  const Slider& of = slider.of;
  const std::string value = fmt::format("{:.4g}{}{}", slider.value, of.unit.empty() ? "" : " ", of.unit);
  ImGui::TextUnformatted(printable(of.name).c_str());
  const float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine();
  if (ImGui::GetCursorPosX() > right) ImGui::NewLine();
  ImGui::SetCursorPosX(right);
  ImGui::TextUnformatted(value.c_str());
  double now = slider.value;
  const bool decades = of.low > 0.0 && of.high >= kDecades * of.low;
  ImGui::SetNextItemWidth(-1.0f);
  const std::string label = fmt::format("{}##{}", printable(of.name), number);
  const bool changed = ImGui::SliderScalar(
      ("##" + label).c_str(), ImGuiDataType_Double, &now, &of.low, &of.high, "",
      ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput | (decades ? ImGuiSliderFlags_Logarithmic : 0));
  const bool begins = ImGui::IsItemActivated();
  ui::known_as(printable(of.name));
  if (of.step > 0.0) now = std::min(of.high, of.low + of.step * std::round((now - of.low) / of.step));
  if ((changed && now != slider.value) || begins) orders.set = SliderOrder{number, now, begins};
}

void draw_sliders(const SidePanel& panel, PanelOrders& orders) {
  if (panel.sliders.empty()) return;
  const ui::Scope scope("Sliders");
  for (std::size_t i = 0; i < panel.sliders.size(); ++i) draw_slider(panel.sliders[i], i, orders);
  if (ui::button("Undo", "The last change of a slider", panel.can_undo)) orders.undo = true;
  ImGui::SameLine();
  const bool moved = std::any_of(panel.sliders.begin(), panel.sliders.end(),
                                 [](const PanelSlider& each) { return each.value != each.authored; });
  if (ui::button("Reset", "All sliders as the level has them", moved)) orders.reset = true;
  ImGui::Separator();
}

void draw_hands(const SidePanel& panel, PanelOrders& orders) {
  if (panel.hands.size() < 2 && panel.holds) return;
  if (panel.hands.empty()) return;
  const ui::Scope scope("Mouse");
  ui::dim("The mouse moves (M: the next)");
  for (std::size_t i = 0; i < panel.hands.size(); ++i)
    if (ui::choice_button(panel.hands[i].c_str(), panel.holds == i, "Moved by the mouse from now on")) orders.hold = i;
  ImGui::Separator();
}

void draw_buttons(const SidePanel& panel, PanelOrders& orders) {
  if (ui::button("Picture", "Into the run's folder")) orders.picture = true;
  ImGui::SameLine();
  const std::string words =
      panel.recording ? fmt::format("Stop, {:.0f} s###record", *panel.recording) : "Record###record";
  if (ui::button(words.c_str(), "The path that the mouse moves, as a script (CSV) in the run's folder",
                 panel.holds.has_value()))
    orders.record = true;
  ui::known_as("Record");
  ImGui::SameLine();
  if (ui::button("Start anew", "The same level")) orders.open = panel.level;
  ImGui::Separator();
}

// Simultaneous pairs of the last seconds; no line between contacts.
void draw_loop(const ProbeLine& probe, float scale) {
  double force = 0.1, depth = 1e-4;
  for (std::size_t age = 0; age < ProbeHistory::kBins; ++age)
    if (const ProbeHistory::Bin* bin = probe.history.bin(age)) {
      force = std::max(force, static_cast<double>(bin->pair_force));
      depth = std::max(depth, static_cast<double>(bin->pair_depth));
    }
  force = round_above(force);
  depth = round_above(depth);
  ui::dim(fmt::format("{}: force over depth, {:g} s", probe.name, ProbeHistory::kSeconds).c_str());
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, kLoopHeight * scale);
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(0, 0, 0, 90), 4 * scale);
  ui::ImGuiPen pen(*list, {});
  PlotPanel panel{at.x, at.y, size.x, size.y, {0.0, depth}, {0.0, force}};
  std::vector<PlotPoint> points;
  for (std::size_t age = ProbeHistory::kBins; age-- > 0;) {
    const ProbeHistory::Bin* bin = probe.history.bin(age);
    const bool touches = bin && bin->pair_depth > 0.0f;
    const double gap = std::nan("");
    points.push_back(touches ? PlotPoint{static_cast<double>(bin->pair_depth), static_cast<double>(bin->pair_force)}
                             : PlotPoint{gap, gap});
  }
  draw_line(pen, panel, points, {ui::plot_color(kLawColor), 1.5 * static_cast<double>(scale)});
  const std::string top = fmt::format("{:g} N", force), right = fmt::format("{:g} mm", depth * 1e3);
  const ImU32 faint = IM_COL32(160, 170, 180, 190);
  list->AddText({at.x + 5 * scale, at.y + 2 * scale}, faint, top.c_str());
  const ImVec2 wide = ImGui::CalcTextSize(right.c_str());
  list->AddText({at.x + size.x - wide.x - 5 * scale, at.y + size.y - wide.y - 2 * scale}, faint, right.c_str());
  ImGui::Dummy(size);
  ImGui::Separator();
}

}  // namespace

void Overlay::draw_side_panel(const OverlayState& state) {
  const SidePanel& panel = state.panel;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float wide = 232 * scale_, edge = 12 * scale_, devices = state.show_devices ? 304 * scale_ + edge : 0;
  ImGui::SetNextWindowPos({size.x - edge - devices, edge}, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSizeConstraints({wide, 0}, {wide, std::max(size.y - 2 * edge, 1.0f)});
  ImGui::Begin("levels", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  draw_sliders(panel, panel_orders_);
  draw_hands(panel, panel_orders_);
  if (panel.plots && size.y >= kRoomForLoop * scale_) draw_loop(state.probes[*panel.plots], scale_);
  {
    const ui::Scope scope("Levels");
    draw_buttons(panel, panel_orders_);
    for (const std::string& level : panel.levels) {
      const std::string name = printable(std::filesystem::path(level).stem().string());
      const bool runs = level == panel.level || name == panel.level;
      if (ui::selectable((name + "##" + level).c_str(), runs)) panel_orders_.open = level;
      ui::known_as(name);
    }
  }
  ImGui::End();
}

}  // namespace pliant
