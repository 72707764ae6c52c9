// Growth of costs: ticks and frames with the size of a mesh and the number of moving vertices, soft steps with
// tetrahedra and contacts. Powers are fitted to the measured times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/csv.h"
#include "lab/study/pareto.h"
#include "lab/study/scale/drawn_frame.h"
#include "lab/study/scale/power_law.h"
#include "lab/study/scale/step_cost.h"
#include "lab/study/scale/tick_cost.h"
#include "lab/study/studies.h"
#include "systems/visual/gpu/context.h"

namespace pliant {
namespace {

constexpr std::uint32_t kAwake = 500;  // vertices in the reach; whole zones, about a thousand vertices, move
// Cells and beds between those of bench/soft_step.cpp, so that a power is fitted to more points than it needs.
constexpr scenes::PaddleCells kCells[]{{9, 2, 5},   {11, 3, 6},  {14, 3, 8}, {18, 4, 11},
                                       {24, 5, 14}, {30, 6, 18}, {38, 8, 22}};
constexpr scenes::StudBed kStuds[]{{1, 3, 3}, {1, 6, 3}, {1, 9, 3}, {2, 4, 5},
                                   {2, 3, 9}, {3, 4, 7}, {4, 4, 7}, {6, 4, 7}};
constexpr int kFineCells = 15'000;  // tetrahedra: fewer steps from this number
constexpr int kMostQuick = 11'000;  // tetrahedra
constexpr int kMostSmall = 1'500;   // tetrahedra
constexpr const char* kMicroseconds = "time [us]";
constexpr const char* kScaleTitle =
    "how costs grow, and the powers of the larger half of the sizes with their 95 % intervals";

// The renderer, if there is one.
struct Drawing {
  std::unique_ptr<HeadlessContext> context;
  std::string renderer;   // GL_RENDERER
  std::string not_drawn;  // reason why no frames are drawn
  std::string too_large;  // reason why large meshes are not drawn
  bool with_cpu = true;

  DrawnCount count(int frames) const { return {not_drawn.empty() ? frames : 0, with_cpu}; }
  // Describes a drawn frame, or the reason why there is none.
  std::string words() const {
    if (!not_drawn.empty()) return "no frame was drawn: " + not_drawn;
    return fmt::format("{} x {} pixels on {}, {}{}", kDrawnWidth, kDrawnHeight, renderer,
                       with_cpu ? "processor time of all threads" : "time until the picture is complete",
                       too_large.empty() ? "" : "; the largest mesh was not drawn: " + too_large);
  }
};

Drawing start_drawing() {
  Drawing drawing;
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  if (!context) {
    drawing.not_drawn = context.error().message();
    return drawing;
  }
  drawing.context = std::move(context).value();
  drawing.renderer = drawing.context->renderer_name();
  drawing.with_cpu = draws_with_cpu(drawing.renderer);
  return drawing;
}

GrowthPanel ticks_panel(const std::vector<TickCost>& costs, bool by_awake, bool drawn) {
  GrowthPanel panel;
  panel.title = by_awake ? fmt::format("{} vertices, by those that move", two_digits(costs[0].vertices))
                         : fmt::format("about {} move, by all vertices", two_digits(costs.back().awake));
  panel.across = by_awake ? "vertices that move" : "vertices";
  panel.up = kMicroseconds;
  GrowthCurve half{"tick, p50", {}, {}}, most{"tick, p99", {}, {}}, published{"frame: publishing", {}, {}},
      whole{"frame: drawn", {}, {}};
  panel.also = by_awake ? "vertices" : "vertices that move";
  for (const TickCost& cost : costs) {
    panel.size.push_back(by_awake ? cost.awake : cost.vertices);
    panel.also_size.push_back(by_awake ? cost.vertices : cost.awake);
    half.cost.push_back(cost.p50_us);
    most.cost.push_back(cost.p99_us);
    published.cost.push_back(cost.frame_us);
    whole.cost.push_back(cost.drawn_us > 0.0 ? cost.drawn_us : std::nan(""));
  }
  panel.curves = {most, half, published};
  if (drawn) panel.curves.push_back(whole);
  return panel;
}

GrowthPanel steps_panel(const std::vector<StepCost>& costs, bool by_contacts) {
  GrowthPanel panel;
  panel.title = by_contacts ? fmt::format("a soft step, {} tetrahedra, by contacts",
                                          two_digits(static_cast<double>(costs[0].tetrahedra)))
                            : fmt::format("a soft step, about {:.0f} contacts, by tetrahedra", costs[0].contacts);
  panel.across = by_contacts ? "contacts" : "tetrahedra";
  panel.up = "time [ms]";
  panel.also = by_contacts ? "tetrahedra" : "contacts";
  for (const StepCost& cost : costs) {
    const auto tets = static_cast<double>(cost.tetrahedra);
    panel.size.push_back(by_contacts ? cost.contacts : tets);
    panel.also_size.push_back(by_contacts ? tets : cost.contacts);
  }
  for (const StepPart part : kStepParts) {
    GrowthCurve curve{name_of(part), {}, {}};
    for (const StepCost& cost : costs) curve.cost.push_back(cost.ms[static_cast<std::size_t>(part)]);
    panel.curves.push_back(curve);
  }
  return panel;
}

std::string csv_of(const std::vector<GrowthPanel>& panels) {
  std::string csv =
      "panel,curve,size,also,also_size,cost,unit,fitted,power,power_within_95,straight,curvature,curvature_within_95,"
      "power_at_end\n";
  for (const GrowthPanel& panel : panels)
    for (const GrowthCurve& curve : panel.curves)
      for (std::size_t i = 0; i < panel.size.size(); ++i) {
        if (std::isnan(curve.cost[i])) continue;
        const PowerLaw& law = curve.law;
        csv += fmt::format("by {},{},{:.6g},{},{:.6g},{:.4g},{},{:d}", panel.across, csv_text(curve.name),
                           panel.size[i], panel.also, panel.also_size[i], curve.cost[i],
                           panel.up == kMicroseconds ? "us" : "ms", panel.size[i] >= law.from * (1 - 1e-9));
        put(csv, law.power);
        csv += std::isfinite(law.within) ? fmt::format(",{:.4g}", law.within) : ",";
        csv += law.straight() ? ",1" : ",0";
        put(csv, law.curvature);
        csv += std::isfinite(law.curvature_within) ? fmt::format(",{:.4g}", law.curvature_within) : ",";
        put(csv, law.power_at_end);
        csv += '\n';
      }
  return csv;
}

nlohmann::ordered_json json_of(const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences,
                               const Drawing& drawing) {
  nlohmann::ordered_json json;
  json["study"] = "scale";
  json["title"] = kScaleTitle;
  json["renderer"] = nullptr;
  if (drawing.not_drawn.empty()) json["renderer"] = drawing.renderer;
  json["frames"] = drawing.words();
  for (const GrowthPanel& panel : panels) {
    nlohmann::ordered_json one{{"title", panel.title}, {"across", panel.across}, {"up", panel.up},
                               {"size", panel.size},   {"also", panel.also},     {"also_size", panel.also_size}};
    for (const GrowthCurve& curve : panel.curves) {
      const PowerLaw& law = curve.law;  // not finite: null
      one["curves"].push_back({{"name", curve.name},
                               {"cost", curve.cost},
                               {"fitted_from", law.from},
                               {"power", law.power},
                               {"power_within_95", law.within},
                               {"straight", law.straight()},
                               {"curvature", law.curvature},
                               {"curvature_within_95", law.curvature_within},
                               {"power_at_end", law.power_at_end}});
    }
    json["panels"].push_back(std::move(one));
  }
  json["shows"] = sentences;
  return json;
}

std::vector<std::string> sentences_of(const std::vector<GrowthPanel>& panels, const Drawing& drawing) {
  const auto& [sizes, awake, tets, contacts] = std::tie(panels[0], panels[1], panels[2], panels[3]);
  const GrowthCurve& tick = sizes.curves[1];
  const auto [least, most] = std::minmax_element(sizes.also_size.begin(), sizes.also_size.end());
  std::string first = fmt::format(
      "Where {} to {} vertices move a tick takes {:.3g} us on a mesh of {} and {:.3g} us on one of {} (power {}), and "
      "with {:.3g} times as many that move {:.3g} times as long (power {}); ",
      two_digits(*least), two_digits(*most), tick.cost.front(), two_digits(sizes.size.front()), tick.cost.back(),
      two_digits(sizes.size.back()), words_of(tick.law), awake.size.back() / awake.size.front(),
      awake.curves[1].cost.back() / awake.curves[1].cost.front(), words_of(awake.curves[1].law));
  if (drawing.not_drawn.empty()) {
    const GrowthCurve& by_size = sizes.curves.back();
    const std::size_t last = by_size.last();
    first += fmt::format("a drawn frame takes {} to {} ms, {} us a vertex of the largest mesh drawn: ",
                         two_digits(by_size.cost.front() * 1e-3), two_digits(by_size.cost[last] * 1e-3),
                         two_digits(by_size.cost[last] / sizes.size[last]));
  }
  first += drawing.words();
  return {first + ".",
          fmt::format(
              "A soft step grows with power {} of tetrahedra (free motion {}, linear models {}) and {} of contacts "
              "(finding them {}, solving them {}); powers are those of the larger half of the sizes, and where the "
              "points are curved there, the power at the largest is said too.",
              words_of(tets.curves[0].law), words_of(tets.curves[1].law), words_of(tets.curves[4].law),
              words_of(contacts.curves[0].law), words_of(contacts.curves[2].law), words_of(contacts.curves[3].law))};
}

}  // namespace

Status study_scale(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const bool quick = size != StudySize::kFull, small = size == StudySize::kSmall;
  using Sizes = std::vector<std::uint32_t>;
  const Sizes vertices = small ? Sizes{1'000, 3'000, 10'000}
                         : quick
                             ? Sizes{1'000, 3'000, 10'000, 30'000, 100'000}
                             : Sizes{1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000, 10'000'000};
  const Sizes moving = small   ? Sizes{500, 1'000, 2'000}
                       : quick ? Sizes{500, 1'000, 2'000, 4'000, 8'000}
                               : Sizes{500, 1'000, 2'000, 4'000, 8'000, 16'000, 32'000, 64'000, 128'000};
  const int ticks = small ? 200 : quick ? 2'000 : 10'000, batches = quick ? 5 : 10;
  const int most_tets = small ? kMostSmall : quick ? kMostQuick : std::numeric_limits<int>::max();
  Progress progress("study scale");
  Drawing drawing = start_drawing();
  std::vector<TickCost> by_size, by_awake;
  std::vector<StepCost> by_tets, by_contacts;
  double done = 0.0;
  // `weight`: approximate relative duration of a measurement.
  const auto measured = [&](double weight) { progress.update((done += weight) / (quick ? 23.0 : 96.0)); };
  const auto keep_reason = [&](const TickCost& cost) {
    if (!cost.not_drawn.empty()) drawing.too_large = cost.not_drawn;
  };
  for (const std::uint32_t count : vertices) {
    if (interrupt.requested()) return interrupted();
    by_size.push_back(measure_tick(count, kAwake, ticks, batches, drawing.count(small ? 1 : count > 300'000 ? 3 : 9)));
    keep_reason(by_size.back());
    measured(count > 5'000'000 ? 24 : count > 1'000'000 ? 8 : 1);
  }
  for (const std::uint32_t awake : moving) {
    if (interrupt.requested()) return interrupted();
    by_awake.push_back(measure_tick(small   ? 10'000
                                    : quick ? 100'000
                                            : 1'000'000,
                                    awake, ticks, batches, drawing.count(small ? 1 : 3)));
    keep_reason(by_awake.back());
    measured(quick ? 1 : 3);
  }
  for (const scenes::PaddleCells& cells : kCells) {
    if (interrupt.requested()) return interrupted();
    if (cells.tetrahedra() > most_tets) continue;
    by_tets.push_back(measure_step(cells, scenes::kUsualBed,
                                   small                             ? 2
                                   : quick                           ? 8
                                   : cells.tetrahedra() > kFineCells ? 24
                                                                     : 60));
    measured(quick ? 1 : cells.tetrahedra() > kFineCells ? 6 : 2);
  }
  for (const scenes::StudBed& bed : kStuds) {
    if (interrupt.requested()) return interrupted();
    if (small && by_contacts.size() == 2) break;
    by_contacts.push_back(measure_step(small ? kCells[0] : scenes::kUsualPaddle, bed, small ? 2 : quick ? 8 : 60));
    measured(1);
  }
  const auto is_drawn = [](const TickCost& cost) { return cost.drawn_us > 0.0; };
  if (drawing.not_drawn.empty() && (std::count_if(by_size.begin(), by_size.end(), is_drawn) < 2 ||
                                    std::count_if(by_awake.begin(), by_awake.end(), is_drawn) < 2))
    drawing.not_drawn = drawing.too_large;
  const bool drawn = drawing.not_drawn.empty();
  std::vector<GrowthPanel> panels{ticks_panel(by_size, false, drawn), ticks_panel(by_awake, true, drawn),
                                  steps_panel(by_tets, false), steps_panel(by_contacts, true)};
  for (GrowthPanel& panel : panels)
    for (GrowthCurve& curve : panel.curves) {
      for (double& cost : curve.cost)
        if (!std::isnan(cost)) cost = std::max(cost, 1e-3);  // below the clock's resolution
      curve.law = fit_power(panel.size, curve.cost);
    }
  const std::vector<std::string> sentences = sentences_of(panels, drawing);
  for (const GrowthPanel& panel : panels) {
    print("scale: {}\n", panel.title);
    for (const GrowthCurve& curve : panel.curves) print("  {:<20} power {}\n", curve.name, words_of(curve.law));
  }
  for (const std::string& sentence : sentences) print("{}\n", sentence);
  if (const Status written = write_text(out, "scale.csv", csv_of(panels)); !written) return written;
  if (const Status written = write_json(out, "scale.json", json_of(panels, sentences, drawing)); !written)
    return written;
  return plot_growth(out, "scale", kScaleTitle, panels, sentences);
}

}  // namespace pliant
