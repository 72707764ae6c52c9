// How costs grow: ticks and frames with the size of a mesh and with what moves on it, soft steps with tetrahedra and
// contacts. Powers are fitted to the measured times.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "player/print.h"
#include "player/progress.h"
#include "player/study/pareto.h"
#include "player/study/power_law.h"
#include "player/study/step_cost.h"
#include "player/study/studies.h"
#include "player/study/tick_cost.h"

namespace pliant {
namespace {

constexpr std::uint32_t kAwake = 500;  // vertices

GrowthPanel ticks_panel(const std::vector<TickCost>& costs, bool by_awake) {
  GrowthPanel panel;
  panel.title = by_awake ? fmt::format("a tick on {:.2g} vertices, by those that move", double(costs[0].vertices))
                         : "a tick and a frame with as many moving vertices, by all vertices";
  panel.across = by_awake ? "vertices that move" : "vertices";
  panel.up = "processor time [us]";
  GrowthCurve half{"tick, p50", {}, {}}, most{"tick, p99", {}, {}}, frame{"frame: publishing", {}, {}};
  for (const TickCost& cost : costs) {
    panel.size.push_back(by_awake ? cost.awake : cost.vertices);
    half.cost.push_back(cost.p50_us);
    most.cost.push_back(cost.p99_us);
    frame.cost.push_back(cost.frame_us);
  }
  panel.curves = {most, half, frame};
  return panel;
}

GrowthPanel steps_panel(const std::vector<StepCost>& costs, bool by_contacts) {
  GrowthPanel panel;
  panel.title = by_contacts ? fmt::format("a soft step of {} tetrahedra, by contacts", costs[0].tetrahedra)
                            : fmt::format("a soft step with about {:.0f} contacts, by tetrahedra", costs[0].contacts);
  panel.across = by_contacts ? "contacts" : "tetrahedra";
  panel.up = "processor time [ms]";
  for (const StepCost& cost : costs)
    panel.size.push_back(by_contacts ? cost.contacts : static_cast<double>(cost.tetrahedra));
  for (const StepPart part : kStepParts) {
    GrowthCurve curve{name_of(part), {}, {}};
    for (const StepCost& cost : costs) curve.cost.push_back(cost.ms[static_cast<std::size_t>(part)]);
    panel.curves.push_back(curve);
  }
  return panel;
}

std::string power(const PowerLaw& law) {
  return std::isfinite(law.within) ? fmt::format("{:.2f} +- {:.2f}", law.power, law.within)
                                   : fmt::format("{:.2f}", law.power);
}

std::string csv_of(const std::vector<GrowthPanel>& panels) {
  std::string csv = "panel,curve,size,cost,unit,power,power_within_95\n";
  for (const GrowthPanel& panel : panels)
    for (const GrowthCurve& curve : panel.curves)
      for (std::size_t i = 0; i < panel.size.size(); ++i)
        csv += fmt::format("by {},\"{}\",{:.6g},{:.4g},{},{:.4g},{:.4g}\n", panel.across, curve.name, panel.size[i],
                           curve.cost[i], panel.up.find("us") != std::string::npos ? "us" : "ms", curve.law.power,
                           curve.law.within);
  return csv;
}

nlohmann::ordered_json json_of(const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences) {
  nlohmann::ordered_json json;
  json["study"] = "scale";
  for (const GrowthPanel& panel : panels) {
    nlohmann::ordered_json one{
        {"title", panel.title}, {"across", panel.across}, {"up", panel.up}, {"size", panel.size}};
    for (const GrowthCurve& curve : panel.curves) {
      nlohmann::ordered_json fitted{{"name", curve.name}, {"cost", curve.cost}, {"power", curve.law.power}};
      fitted["power_within_95"] = nullptr;
      if (std::isfinite(curve.law.within)) fitted["power_within_95"] = curve.law.within;
      one["curves"].push_back(std::move(fitted));
    }
    json["panels"].push_back(std::move(one));
  }
  json["shows"] = sentences;
  return json;
}

std::vector<std::string> sentences_of(const std::vector<GrowthPanel>& panels) {
  const auto& [sizes, awake, tets, contacts] = std::tie(panels[0], panels[1], panels[2], panels[3]);
  const GrowthCurve& tick = sizes.curves[1];
  return {
      fmt::format("From {:.2g} to {:.2g} vertices a tick in which as many move takes {:.3g} to {:.3g} us (power {}), "
                  "and with {:.3g} times as many that move {:.3g} times as long (power {}).",
                  sizes.size.front(), sizes.size.back(), tick.cost.front(), tick.cost.back(), power(tick.law),
                  awake.size.back() / awake.size.front(), awake.curves[1].cost.back() / awake.curves[1].cost.front(),
                  power(awake.curves[1].law)),
      fmt::format("A soft step grows with power {} of tetrahedra (free motion {}, linear models {}) and {} of "
                  "contacts (finding them {}, solving them {}).",
                  power(tets.curves[0].law), power(tets.curves[1].law), power(tets.curves[4].law),
                  power(contacts.curves[0].law), power(contacts.curves[2].law), power(contacts.curves[3].law))};
}

}  // namespace

Status study_scale(OutputFolder& out, bool quick, const Interrupt& interrupt) {
  using Sizes = std::vector<std::uint32_t>;
  const Sizes vertices = quick ? Sizes{1'000, 10'000, 100'000} : Sizes{1'000, 10'000, 100'000, 1'000'000, 10'000'000};
  const Sizes moving = quick ? Sizes{500, 2'000, 8'000} : Sizes{500, 2'000, 8'000, 32'000, 128'000};
  const int ticks = quick ? 1'000 : 5'000;
  Progress progress("study scale");
  std::vector<TickCost> by_size, by_awake;
  std::vector<StepCost> by_tets, by_contacts;
  double done = 0.0;
  // `weight`: about how long a piece takes beside others.
  const auto measured = [&](double weight) { progress.update((done += weight) / (quick ? 13.0 : 50.0)); };
  for (const std::uint32_t size : vertices) {
    if (interrupt.requested()) return interrupted();
    by_size.push_back(measure_tick(size, kAwake, ticks));
    measured(size > 1'000'000 ? 20 : 1);
  }
  for (const std::uint32_t awake : moving) {
    if (interrupt.requested()) return interrupted();
    by_awake.push_back(measure_tick(quick ? 100'000 : 1'000'000, awake, awake > 10'000 ? ticks / 5 : ticks));
    measured(quick ? 1 : 2);
  }
  for (const scenes::PaddleCells& cells : scenes::kPaddles) {
    if (interrupt.requested()) return interrupted();
    if (quick && cells.tetrahedra() > 20'000) continue;
    by_tets.push_back(measure_step(cells, scenes::kUsualBed, quick ? 8 : cells.tetrahedra() > 20'000 ? 24 : 60));
    measured(quick ? 1 : cells.tetrahedra() > 20'000 ? 6 : 2);
  }
  for (const scenes::StudBed& bed : scenes::kBeds) {
    if (interrupt.requested()) return interrupted();
    by_contacts.push_back(measure_step(scenes::kUsualPaddle, bed, quick ? 8 : 60));
    measured(1);
  }
  std::vector<GrowthPanel> panels{ticks_panel(by_size, false), ticks_panel(by_awake, true), steps_panel(by_tets, false),
                                  steps_panel(by_contacts, true)};
  for (GrowthPanel& panel : panels)
    for (GrowthCurve& curve : panel.curves) {
      for (double& cost : curve.cost) cost = std::max(cost, 1e-3);  // what the clock does not resolve
      curve.law = fit_power(panel.size, curve.cost);
    }
  const std::vector<std::string> sentences = sentences_of(panels);
  for (const GrowthPanel& panel : panels) {
    print("scale: {}\n", panel.title);
    for (const GrowthCurve& curve : panel.curves) print("  {:<20} power {}\n", curve.name, power(curve.law));
  }
  for (const std::string& sentence : sentences) print("{}\n", sentence);
  if (const Status written = write_text(out, "scale.csv", csv_of(panels)); !written) return written;
  if (const Status written = write_text(out, "scale.json", json_of(panels, sentences).dump(2, ' ', true) + "\n");
      !written)
    return written;
  return plot_growth(out, "scale", "how costs grow, and the powers fitted to them with their 95 % intervals", panels,
                     sentences);
}

}  // namespace pliant
