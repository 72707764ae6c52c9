#include "editor/panels/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "editor/ui/plot.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kPlotPickReach = 9.0f;  // [point] of the mouse, to a point of the plot
constexpr double kAir = 1.35;           // [1] margin around the outermost points
constexpr double kLeastError = 1e-4;    // [1] drawn value for a zero error
constexpr double kLeastCost = 1e-3;     // [us]

std::string ms_text(const ModelCandidate& it) {
  return it.ms > 0.0 ? fmt::format("{:.2g}", it.ms) : "\u2013";
}

double error_of(const ModelCandidate& it) {
  return std::max(it.error, kLeastError);
}
double cost_of(const ModelCandidate& it) {
  return std::max(it.cost, kLeastCost);
}

PlotAxis axis_over(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least / kAir, *most * kAir, true};
}

void draw_tooltip(const ModelCandidate& it, const char* more) {
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(it.label.c_str());
  std::string figures = fmt::format("Error {:.3g}, about {:.3g} \u00b5s a tick", it.error, it.cost);
  if (it.ms > 0.0) figures += fmt::format("\nMeasured {:.2g} ms", it.ms);
  ImGui::TextColored(ui::palette().dim, "%s", (figures + more).c_str());
  ImGui::EndTooltip();
}

enum Column : int { kLabel, kError, kCost, kMs };

// [1] of a candidate, in a column of numbers.
double number_in(const ModelCandidate& it, int column) {
  return column == kError ? it.error : column == kCost ? it.cost : it.ms;
}

}  // namespace

void CandidateView::table(const ModelChoice& choice, float high, bool faded) {
  pointed_ = std::exchange(points_, std::nullopt);
  const ui::Palette& p = ui::palette();
  const ui::Scope scope("Candidates");
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_Sortable | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                     ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX;
  ImVec4 back = p.text;
  back.w = 0.05f;
  ImGui::PushStyleColor(ImGuiCol_TableHeaderBg, p.raised);
  ImGui::PushStyleColor(ImGuiCol_TableRowBgAlt, back);
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  const auto restore = [] {
    ImGui::PopFont();
    ImGui::PopStyleColor(2);
  };
  if (!ImGui::BeginTable("candidates", 4, kFlags, {0, high})) return restore();
  ImGui::TableSetupScrollFreeze(0, 1);
  constexpr ImGuiTableColumnFlags kFigure = ImGuiTableColumnFlags_WidthFixed;
  ImGui::TableSetupColumn("Model", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("Error", kFigure, ui::px(46));
  ImGui::TableSetupColumn("\u00b5s a tick", kFigure | ImGuiTableColumnFlags_DefaultSort, ui::px(62));
  ImGui::TableSetupColumn("ms here", kFigure, ui::px(48));
  ImGui::TableHeadersRow();
  ImGuiTableSortSpecs* const sort = ImGui::TableGetSortSpecs();
  order_.resize(choice.tried.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  if (sort && sort->SpecsCount > 0) {
    const int column = sort->Specs[0].ColumnIndex;
    const bool down = sort->Specs[0].SortDirection == ImGuiSortDirection_Descending;
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      const ModelCandidate &x = choice.tried[down ? b : a], &y = choice.tried[down ? a : b];
      return column == kLabel ? x.label < y.label : number_in(x, column) < number_in(y, column);
    });
  }
  for (const std::size_t i : order_) {
    const ModelCandidate& it = choice.tried[i];
    const bool chosen = i == choice.chosen, within = it.error <= choice.budget;
    const ImVec4& ink = faded ? p.faint : chosen ? p.text : within ? p.text : p.dim;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushID(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    if (pointed_ == i) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ui::color(p.text, 0.12f));
    (void)ImGui::Selectable(fmt::format("{} {}", chosen ? "\u2713" : "   ", it.label).c_str(), chosen,
                            ImGuiSelectableFlags_SpanAllColumns);
    ui::known_as(it.label);
    if (ImGui::IsItemHovered()) {
      points_ = i;
      draw_tooltip(it, !chosen         ? ""
                       : choice.within ? "\nChosen: the cheapest within the budget"
                                       : "\nChosen: the nearest; none is within the budget");
    }
    const auto figure = [&](const std::string& text) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(text.c_str());
    };
    figure(fmt::format("{:.3g}", it.error));
    figure(it.cost < 100.0 ? fmt::format("{:.3g}", it.cost) : fmt::format("{:.0f}", it.cost));
    figure(ms_text(it));
    ImGui::PopStyleColor();
    ImGui::PopID();
  }
  ImGui::EndTable();
  restore();
}

void CandidateView::plot(const ModelChoice& choice, float wide, float high, bool faded) {
  const ui::Palette& p = ui::palette();
  std::vector<double> errors{std::max(choice.budget, kLeastError)}, costs;
  for (const ModelCandidate& it : choice.tried) {
    errors.push_back(error_of(it));
    costs.push_back(cost_of(it));
  }
  ui::Plot plot("Error against cost", "Error [1]", {wide, high}, axis_over(costs), "\u00b5s a tick", axis_over(errors));
  // The Pareto front, as steps from the cheapest on.
  std::vector<dvec2> front;
  for (const ModelCandidate& it : choice.tried)
    if (front.empty() || error_of(it) < front.back().y) {
      if (!front.empty()) front.emplace_back(cost_of(it), front.back().y);
      front.emplace_back(cost_of(it), error_of(it));
    }
  plot.curve(
      front.size(), [&](std::size_t i) { return front[i]; }, p.faint, 1.0f);
  plot.level(errors.front(), p.accent, fmt::format("budget {:.3g}", choice.budget).c_str());
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  float nearest = ui::px(kPlotPickReach);
  for (std::size_t i = 0; i < choice.tried.size(); ++i) {
    const ModelCandidate& it = choice.tried[i];
    const dvec2 at(cost_of(it), error_of(it));
    const bool chosen = i == choice.chosen, within = it.error <= choice.budget;
    // Within the budget a disc, else a ring; the chosen one has an outer ring. Shapes, because colour alone is not
    // enough.
    plot.dot(at, faded ? p.faint : within ? p.good : p.dim, 3.5f, within);
    if (chosen) plot.dot(at, faded ? p.faint : p.accent, 7.0f, false);
    if (pointed_ == i) plot.dot(at, p.text, 5.5f, false);
    const ImVec2 place = plot.on(at);
    {
      const ui::Scope scope("Points");
      ui::known_at(it.label, {place.x - 1, place.y - 1}, {place.x + 1, place.y + 1});
    }
    const float far = std::hypot(mouse.x - place.x, mouse.y - place.y);
    if (plot.hovered() && far < nearest) {
      nearest = far;
      points_ = i;
    }
  }
  if (plot.hovered() && points_) draw_tooltip(choice.tried[*points_], "");
}

}  // namespace pliant
