// pliant fit DATA.csv: a contact law fitted to measured presses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "content/author/touchable.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/files/csv.h"
#include "lab/files/output_folder.h"
#include "lab/fit/fit.h"
#include "lab/fit/fit_level.h"
#include "lab/fit/fit_record.h"
#include "lab/study/pareto.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

// `held_out`: whether there are rows that the fit has not seen; without them their error is null.
OrderedJson law_json(const LawFit& fit, bool held_out) {
  OrderedJson parameters = OrderedJson::array();
  for (const FittedParameter& p : fit.parameters) {
    OrderedJson one{{"key", p.key}, {"unit", p.unit}, {"value", p.value}};
    if (p.on_bound || fit.singular)
      one["interval"] = nullptr;
    else
      one["interval"] = {p.low, p.high};
    one["on_bound"] = p.on_bound;
    parameters.push_back(one);
  }
  return {{"law", fit.model.law},
          {"parameters", parameters},
          {"rms_N", fit.rms},
          {"rms_share", fit.share},
          {"held_out_rms_N", held_out ? OrderedJson(fit.held_rms) : OrderedJson()},
          {"held_out_rms_share", held_out ? OrderedJson(fit.held_share) : OrderedJson()},
          {"residual_correlation", fit.correlation},
          {"converged", fit.converged},
          {"singular", fit.singular}};
}

std::string report_of(const PressRecord& record, const RecordFit& fit, const FitOptions& options) {
  OrderedJson laws = OrderedJson::array();
  for (const LawFit& law : fit.laws) laws.push_back(law_json(law, fit.fitted < record.size()));
  const OrderedJson report{{"record", record.name},
                           {"rows", record.size()},
                           {"rows_fitted", fit.fitted},
                           {"confidence", options.confidence},
                           {"radius_m", options.radius},
                           {"best", fit.laws[fit.best].model.law},
                           {"laws", laws},
                           {"notes", fit.notes}};
  return report.dump(2, ' ', true, OrderedJson::error_handler_t::replace) + "\n";
}

std::string residuals_csv(const PressRecord& record, const RecordFit& fit) {
  const LawFit& law = fit.laws[fit.best];
  std::string text =
      std::string("row") + (record.time.empty() ? "" : ",time_s") + ",depth_m,force_N,model_N,residual_N,held_out\n";
  for (std::size_t i = 0; i < record.size(); ++i) {
    text += std::to_string(i + 1);
    if (!record.time.empty()) put(text, record.time[i]);
    for (const double value : {record.depth[i], record.force[i], law.force[i], law.force[i] - record.force[i]})
      put(text, value);
    text += fit.held[i] ? ",1\n" : ",0\n";
  }
  return text;
}

std::string sentence_of(const LawFit& law) {
  std::string words = law.model.law + ":";
  for (const FittedParameter& p : law.parameters) {
    words += fmt::format(" {} {:.4g}", p.key, p.value);
    if (!p.on_bound && !law.singular) words += fmt::format(" ({:.4g} to {:.4g})", p.low, p.high);
    words += " " + p.unit + (&p == &law.parameters.back() ? "" : ",");
  }
  return words;
}

// Scales values into [1e-3, ...], so that axis labels need no exponents.
struct Prefix {
  double factor;
  const char* name;
};
Prefix prefix_of(double largest) {
  return largest < 0.5e-3 ? Prefix{1e6, "u"} : largest < 0.5 ? Prefix{1e3, "m"} : Prefix{1.0, ""};
}

void draw_record(Pen& pen, const PressRecord& record, const RecordFit& fit, const FitOptions& options) {
  const LawFit& law = fit.laws[fit.best];
  double deepest = 0.0, strongest = 0.0, off = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    deepest = std::max(deepest, record.depth[i]);
    strongest = std::max(strongest, std::abs(record.force[i]));
    off = std::max(off, std::abs(law.force[i] - record.force[i]));
  }
  const Prefix length = prefix_of(deepest), newton = prefix_of(strongest), rest = prefix_of(off);
  std::vector<double> depth, force, model, residual, across;
  std::vector<PlotPoint> held_force, held_residual, kept_force, kept_residual;
  for (std::size_t i = 0; i < record.size(); ++i) {
    depth.push_back(record.depth[i] * length.factor);
    force.push_back(record.force[i] * newton.factor);
    model.push_back(law.force[i] * newton.factor);
    residual.push_back((law.force[i] - record.force[i]) * rest.factor);
    across.push_back(record.time.empty() ? depth.back() : record.time[i]);
    (fit.held[i] ? held_force : kept_force).push_back({depth.back(), force.back()});
    (fit.held[i] ? held_residual : kept_residual).push_back({across.back(), residual.back()});
  }
  const auto range = [](const std::vector<double>& values, bool with_zero) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return range_of(*least, *most, with_zero);
  };
  const double dot = record.size() > 2000 ? 1.6 : 3.2;
  std::vector<double> both = force;
  both.insert(both.end(), model.begin(), model.end());
  const PlotPanel left{110, 150, 640, 500, range(depth, true), range(both, true)};
  const PlotPanel right{890, 150, 670, 500, range(across, false), range(residual, true)};
  draw_axes(pen, left, fmt::format("depth [{}m]", length.name), fmt::format("force [{}N]", newton.name));
  draw_dots(pen, left, kept_force, kBlue, dot, true, 0.75);
  draw_dots(pen, left, held_force, kOrange, dot, true, 0.75);
  // Without time the rows are sorted by depth, so that a line can be drawn through them.
  std::vector<std::size_t> order(record.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (record.time.empty())
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  std::vector<PlotPoint> line;
  for (const std::size_t i : order) line.push_back({depth[i], model[i]});
  draw_line(pen, left, line, {kInk});
  draw_axes(pen, right, record.time.empty() ? fmt::format("depth [{}m]", length.name) : "time [s]",
            fmt::format("model - measured [{}N]", rest.name));
  draw_dots(pen, right, kept_residual, kBlue, dot, true, 0.75);
  draw_dots(pen, right, held_residual, kOrange, dot, true, 0.75);
  draw_level(pen, right, 0.0, {kInk, 1.2});
  pen.color(kInk);
  const double title = pen.text(60, 46, 26, 0, "fit", true);
  pen.text(60 + title + 18, 46, 16, 0, record.name);
  double y = 74;
  for (const std::string& text :
       pen.lines(15, sentence_of(law) + fmt::format("  ({:g} % intervals)", 100 * options.confidence), 1500)) {
    pen.text(60, y, 15, 0, text);
    y += 19;
  }
  draw_keys(pen, left.x, 134, 1560,
            {{kBlue, fmt::format("fitted rows: RMS {:.2g} % of the force", 100 * law.share), KeyMark::kDot},
             {kOrange, fmt::format("rows held out: {:.2g} %", 100 * law.held_share), KeyMark::kDot},
             {kInk, law.model.law}});
  y = 722;
  for (const std::string& sentence : fit.notes)
    for (const std::string& text : pen.lines(14, sentence, 1500)) {
      pen.text(60, y, 14, 0, text);
      y += 18;
    }
}

void say(const PressRecord& record, const RecordFit& fit, const FitOptions& options) {
  print("{}: {} rows, {} fitted, {} held out\n", record.name, record.size(), fit.fitted, record.size() - fit.fitted);
  for (const LawFit& law : fit.laws)
    print("  {:<12} RMS {:.3g} N ({:.2g} %){}{}\n", law.model.law, law.rms, 100 * law.share,
          fit.fitted < record.size() ? fmt::format(", held out {:.3g} N ({:.2g} %)", law.held_rms, 100 * law.held_share)
                                     : "",
          &law == &fit.laws[fit.best] ? "  <- taken" : "");
  for (const FittedParameter& p : fit.laws[fit.best].parameters)
    print("  {} = {:.6g} {}{}\n", p.key, p.value, p.unit,
          p.on_bound || fit.laws[fit.best].singular
              ? std::string(", no interval")
              : fmt::format(", {:g} % within {:.6g} and {:.6g}", 100 * options.confidence, p.low, p.high));
}

// Writes the law's keys into the node; its other keys are kept.
Status write_keys(const LawFit& fit, const FitOptions& options, Level& level, std::int32_t number) {
  LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
  const Deformable fitted = fit.model.deformable(fit.p);
  if (node.soft_body) {
    if (!of_modulus(fit.model.law))
      return Error{"--object " + node.name, "is a soft body, which has a modulus and no law",
                   "fit with --law hertz or sneddon and --radius, or name a deformable surface"};
    node.soft_body->young = fitted.young;
    node.soft_body->poisson = std::min(fitted.poisson, 0.499);
    return Done{};
  }
  if (!node.deformable)
    if (const Status made = make_touchable_surface(level, number); !made) return made;
  Deformable& it = *level.nodes[static_cast<std::size_t>(number)].deformable;
  it.spring = fitted.spring;
  if (reads_key(fitted.spring, "table")) it.table = fitted.table;
  it.stiffness = fitted.stiffness;
  it.cubic = reads_key(fitted.spring, "cubic") ? fitted.cubic : it.cubic;
  it.stiffening = reads_key(fitted.spring, "stiffening") ? fitted.stiffening : it.stiffening;
  if (has_arm(fitted.spring)) {
    it.relaxation_stiffness = fitted.relaxation_stiffness;
    it.relaxation_time = fitted.relaxation_time;
  }
  if (options.damping) {
    it.contact_damping = fitted.contact_damping;
    it.contact_damping_material = false;
  }
  it.young = fitted.young;
  if (fitted.young > 0) {
    it.poisson = fitted.poisson;
    it.thickness = fitted.thickness;
    it.sphere = fitted.sphere;
  }
  return Done{};
}

}  // namespace

int fit_press(const FitOptions& options) {
  if (!options.out.empty() && options.level.empty())
    return fail(kUsage,
                {"-o " + options.out, "what was measured is no level", "say with --level into which one it goes"});
  if (!options.level.empty() && options.out.empty())
    return fail(kUsage, {"--level " + options.level, "say with -o where the level is written"});
  if (const Status out = check_out(options); !out) return fail(kUsage, out.error());
  const Result<PressRecord> record = read_press(options.in, options.probe);
  if (!record) return fail(kFailed, record.error());
  for (const std::string& sentence : record->notes) note(sentence);
  RecordFitOptions record_options;
  record_options.law = options.law;
  record_options.model = {options.radius, options.poisson < 0 ? 0.45 : options.poisson,
                          std::max(options.thickness, 0.0), options.damping, options.contact};
  record_options.hold_out = options.hold_out;
  record_options.confidence = options.confidence;
  const Result<RecordFit> fit = fit_record(*record, record_options);
  if (!fit) return fail(kFailed, fit.error());
  const LawFit& best = fit->laws[fit->best];
  std::optional<Level> level;
  if (!options.level.empty()) {
    Result<Level> read = level_to_fit(options.level, options.unit);
    if (!read) return fail(kFailed, read.error());
    level.emplace(std::move(read).value());
    const Result<std::int32_t> object = object_to_fit(*level, options.object);
    if (!object) return fail(kUsage, object.error());
    if (const Status s = write_keys(best, options, *level, *object); !s) return fail(kUsage, s.error());
  }
  const Interrupt interrupt(kAllOrNothing);  // removes staged files on interruption
  auto out = OutputFolder::create(options.report.empty() ? "out/fit" : options.report, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  Status done = write_text(*out, "fit.json", report_of(*record, *fit, options));
  if (done) done = write_text(*out, "fit_residuals.csv", residuals_csv(*record, *fit));
  if (done)
    done = draw_png_and_svg(out->stage("fit.png"), out->stage("fit.svg"), 1600, 800,
                            [&](Pen& pen) { draw_record(pen, *record, *fit, options); });
  if (!done) return fail(kFailed, out->at_place(done.error()));
  if (interrupt.requested()) return fail(kFailed, interrupted("fit"));
  if (level)
    if (const Status s = save_fitted(*level, options); !s) return fail(kFailed, s.error());
  if (const Status placed = out->commit(); !placed) return fail(kFailed, placed.error());
  say(*record, *fit, options);
  for (const std::string& sentence : fit->notes) note(sentence);
  if (of_modulus(best.model.law))
    note(fmt::format("`young` makes the force of a sphere by its radius: a probe of {:g} m feels what was measured",
                     options.radius));
  if (!options.out.empty()) print("{}: a level\n", options.out);
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces them)" : "");
  return kDone;
}

}  // namespace pliant
