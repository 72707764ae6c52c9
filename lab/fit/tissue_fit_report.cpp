#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/console/print.h"
#include "lab/files/csv.h"
#include "lab/fit/tissue_fit.h"
#include "lab/study/pareto.h"
#include "lab/study/shapes/study_shapes.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kForceGoal = 0.05, kSurfaceGoal = 0.10;  // [1]

}  // namespace

std::string places_csv(const TissueFit& fitted) {
  std::string text =
      "place,side,x,y,z,depth_m,fem_N,p1_N,force_error,surface_error,surface_over_depth,not_radial_over_depth,near_"
      "edge\n";
  for (std::size_t i = 0; i < fitted.held.size(); ++i) {
    const HeldPlace& held = fitted.held[i];
    for (std::size_t k = 0; k < std::min(held.truth.presses.size(), held.model.size()); ++k) {
      text += std::to_string(i + 1) + "," + word_of(held.side);
      put(text, held.truth.place.position);
      for (const double value : {held.truth.presses[k].depth, held.truth.presses[k].force, held.model[k].force,
                                 held.model[k].force / held.truth.presses[k].force - 1})
        put(text, value);
      if (k + 1 == std::min(held.truth.presses.size(), held.model.size())) {
        put(text, held.surface_error);
        put(text, held.surface_of_depth);
        put(text, held.not_radial);
        text += held.near_edge ? ",1" : ",0";
      } else {
        text += ",,,,";
      }
      text += "\n";
    }
  }
  return text;
}

std::map<std::string, PlaceErrors> sums_of(const TissueFit& fitted) {
  std::map<std::string, PlaceErrors> out;
  const bool edges =
      std::any_of(fitted.held.begin(), fitted.held.end(), [](const HeldPlace& h) { return h.near_edge; });
  for (const HeldPlace& held : fitted.held) {
    if (held.truth.presses.empty()) continue;
    out["all"].add(held);
    if (edges && !held.near_edge) out["inner"].add(held);
    out[word_of(held.side)].add(held);
  }
  return out;
}

std::string verdict_of(const TissueFit& fitted) {
  const auto sums = sums_of(fitted);
  const auto all = sums.find("all");
  if (all == sums.end()) return "No place was left to check the fit at.";
  const PlaceErrors& sum = all->second;
  const auto good =
      static_cast<std::size_t>(std::count_if(fitted.held.begin(), fitted.held.end(), [](const HeldPlace& held) {
        return !held.truth.presses.empty() && held.force_error <= kForceGoal && held.surface_of_depth <= kSurfaceGoal;
      }));
  const bool quarter = fitted.deepest > 0.249 * fitted.surface.reach;
  std::string text = fmt::format(
      "At {} places that the fit has not seen, up to {}, the surface's force is off by {:.1f} % "
      "(RMS; {:.1f} % at the worst), and its dents within {:g} radii of the indenter by {:.1f} % of the depth ({:.0f} "
      "% of the dents' own RMS); force within {:g} % and dents within {:g} % of the depth hold at {} of them.",
      sum.count,
      quarter
          ? "a quarter of the reach"
          : fmt::format("{:.2g} of the reach ({:.3g} mm, {:.2g} radii of the indenter: deeper, elements soften "
                        "faster than any law)",
                        fitted.deepest / fitted.surface.reach, fitted.deepest * 1e3, fitted.deepest / fitted.radius),
      100 * sum.rms(sum.force), 100 * sum.worst, kAroundPress, 100 * sum.rms(sum.of_depth), 100 * sum.rms(sum.surface),
      100 * kForceGoal, 100 * kSurfaceGoal, good);
  if (const auto inner = sums.find("inner"); inner != sums.end())
    text += fmt::format(
        " {} of them are pressed nearer to an edge than 1.5 depths, where a probe meets the other side, too; without "
        "them force is off by {:.1f} % and dents by {:.1f} %.",
        sum.count - inner->second.count, 100 * inner->second.rms(inner->second.force),
        100 * inner->second.rms(inner->second.of_depth));
  if (sum.rms(sum.of_depth) > kSurfaceGoal)
    text += " One shape stands for all places: where the object bends or moves as a whole, dents are wider.";
  return text + fmt::format(" No dent that is a function of the distance alone comes nearer than {:.1f} % there.",
                            100 * sum.rms(sum.not_radial));
}

std::string json_of(const TissueFit& f, const Level& level) {
  OrderedJson regions = OrderedJson::array();
  for (const auto& [name, sum] : sums_of(f))
    regions.push_back({{"region", name},
                       {"places", sum.count},
                       {"force_error_rms", sum.rms(sum.force)},
                       {"force_error_worst", sum.worst},
                       {"surface_error_rms", sum.rms(sum.surface)},
                       {"surface_over_depth_rms", sum.rms(sum.of_depth)},
                       {"not_radial_over_depth_rms", sum.rms(sum.not_radial)}});
  const OrderedJson out{
      {"level", level.path.filename().string()},
      {"object", f.object},
      {"young_Pa", f.young},
      {"poisson", f.poisson},
      {"tetrahedra", f.tets},
      {"cell_m", f.cell},
      {"forces_divided_by", f.too_stiff},
      {"forces_divided_by_spread", f.too_stiff_off},
      {"strain", f.linear ? "linear" : "corotational"},
      {"indenter_radius_m", f.radius},
      {"indenter_radius_is", f.why},
      {"deepest_press_m", f.deepest},
      {"map_places", f.mapped},
      {"fit_places", f.places},
      {"left_out_near_what_is_held", f.left_out},
      {"keys",
       {{"spring", word_of(f.surface.spring)},
        {"stiffness", f.surface.stiffness},
        {"cubic", reads_key(f.surface.spring, "cubic") ? OrderedJson(f.surface.cubic) : OrderedJson()},
        {"stiffening", reads_key(f.surface.spring, "stiffening") ? OrderedJson(f.surface.stiffening) : OrderedJson()},
        {"shape", name_of(f.surface.shape)},
        {"reach", f.surface.reach},
        {"volume", f.surface.volume},
        {"contact_radius", f.surface.contact_radius}}},
      {"stiffness_map_N_m", {f.softest, f.stiffest}},
      {"fit_force_error", f.force.error},
      {"fit_surface_error", f.shape.error},
      {"held_out", regions},
      {"sentence", verdict_of(f)}};
  return out.dump(2, ' ', true, OrderedJson::error_handler_t::replace) + "\n";
}

void draw(Pen& pen, const TissueFit& f) {
  double deepest = 0.0, strongest = 0.0;
  std::vector<PlotPoint> all_f, all_s;
  for (const HeldPlace& held : f.held)
    for (std::size_t i = 0; i < std::min(held.truth.presses.size(), held.model.size()); ++i) {
      deepest = std::max(deepest, held.truth.presses[i].depth * 1e3);
      strongest = std::max({strongest, held.truth.presses[i].force, held.model[i].force});
    }
  const std::vector<std::string> verdict = pen.lines(15, verdict_of(f), 1500);
  const double top = std::max(150.0, 74 + 19 * static_cast<double>(verdict.size()) + 30), high = 670 - top;
  const PlotPanel left{110, top, 640, high, range_of(0, deepest, true), range_of(0, strongest, true)};
  const PlotPanel right{890, top, 670, high, range_of(0, static_cast<double>(f.held.size()), true), {0.1, 100, true}};
  draw_axes(pen, left, "depth [mm]", "force [N]");
  std::size_t number = 0;
  for (const HeldPlace& held : f.held) {
    std::vector<PlotPoint> truth{{0.0, 0.0}}, model{{0.0, 0.0}};
    for (std::size_t i = 0; i < std::min(held.truth.presses.size(), held.model.size()); ++i) {
      const double depth = held.truth.presses[i].depth * 1e3;
      truth.push_back({depth, held.truth.presses[i].force});
      model.push_back({depth, held.model[i].force});
    }
    draw_line(pen, left, model, {series_color(number), 1.6});
    draw_dots(pen, left, truth, series_color(number), 4, true, 0.75);
    ++number;
    all_f.push_back({static_cast<double>(number) - 0.5, 100 * held.force_error});
    all_s.push_back({static_cast<double>(number) - 0.5, 100 * held.surface_of_depth});
  }
  draw_axes(pen, right, "place that the fit has not seen", "error [%]");
  for (const auto& [goal, color] : {std::pair{kForceGoal, kVermilion}, std::pair{kSurfaceGoal, kBlue}})
    draw_level(pen, right, 100 * goal, {color, 3, false, 0.35});
  draw_dots(pen, right, all_f, kVermilion, 6, true, 0.75);
  draw_dots(pen, right, all_s, kBlue, 6, true, 0.75);
  pen.color(kInk);
  const double title = pen.text(60, 46, 26, 0, "fit", true);
  pen.text(60 + title + 18, 46, 16, 0,
           fmt::format(
               "{}: P1 from presses into {} tetrahedra each; indenter of radius {:.3g} mm, reach {:.3g} mm, shape {}",
               f.object, f.tets, f.radius * 1e3, f.surface.reach * 1e3, name_of(f.surface.shape)));
  double y = 74;
  for (const std::string& text : verdict) {
    pen.text(60, y, 15, 0, text);
    y += 19;
  }
  draw_keys(pen, left.x, top - 12, left.x + left.w + 60,
            {{kInk, "dots: finite elements", KeyMark::kDot}, {kInk, "lines: the fitted surface, in the engine"}});
  draw_keys(pen, right.x, top - 12, 1590,
            {{kVermilion, "force, RMS (band: 5 %)", KeyMark::kDot},
             {kBlue, "deepest dent, of the depth (band: 10 %)", KeyMark::kDot}});
}

void say(const TissueFit& f) {
  print("{}: indenter of radius {:.3g} mm ({}); {} places mapped, {} fitted, {} held out\n", f.object, f.radius * 1e3,
        f.why, f.mapped, f.places, f.held.size());
  print("  some {} tetrahedra a press, cells of {:.3g} mm under it", f.tets, f.cell * 1e3);
  if (f.too_stiff != 1.0)
    print("; forces divided by {:.3f}, what cells of no size would give (places differ by {:.1f} %)", f.too_stiff,
          100 * f.too_stiff_off);
  print("\n");
  print("  spring {}, stiffness {:.4g} N/m ({:.3g} to {:.3g} over the surface)", word_of(f.surface.spring),
        f.surface.stiffness, f.softest, f.stiffest);
  if (reads_key(f.surface.spring, "cubic")) print(", cubic {:.4g} N/m3", f.surface.cubic);
  if (reads_key(f.surface.spring, "stiffening")) print(", stiffening {:.4g} 1/m", f.surface.stiffening);
  print("\n  shape {}, reach {:.3g} mm", name_of(f.surface.shape), f.surface.reach * 1e3);
  if (row_of(f.surface.shape).parameter == ShapeParameter::kVolume) print(", volume {:.2g}", f.surface.volume);
  if (depends_on_contact(f.surface.shape)) print(", contact_radius {:.3g} mm", f.surface.contact_radius * 1e3);
  print("\n");
  print("  {:<8} {:>6} {:>12} {:>12} {:>12} {:>14} {:>12}\n", "region", "places", "force RMS", "force worst", "dent",
        "dent of depth", "any dent");
  for (const auto& [name, sum] : sums_of(f))
    print("  {:<8} {:>6} {:>10.1f} % {:>10.1f} % {:>10.1f} % {:>12.1f} % {:>10.1f} %\n", name, sum.count,
          100 * sum.rms(sum.force), 100 * sum.worst, 100 * sum.rms(sum.surface), 100 * sum.rms(sum.of_depth),
          100 * sum.rms(sum.not_radial));
  print("{}\n", verdict_of(f));
}

}  // namespace pliant
