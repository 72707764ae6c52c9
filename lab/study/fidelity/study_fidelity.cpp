#include "lab/study/fidelity/study_fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "content/keys/enum_words.h"
#include "content/keys/extensions.h"
#include "lab/console/progress.h"
#include "lab/study/fidelity/fidelity_truth.h"
#include "lab/study/studies.h"

namespace pliant {
namespace {

constexpr double kLatticeSeconds = 0.15;  // [s] per press on the small block: the damping decays in a tenth of it
constexpr SpringLaw kFidelityLaws[] = {SpringLaw::kCubic, SpringLaw::kExponential, SpringLaw::kStandardLinearSolid};

double largest(double a, double b) {
  return std::max(a, b);
}

// One model's row in three tables: by the larger error, by the force's, by the surface's.
struct FidelityRow {
  std::string group, label;
  double us = 0.0, force = 0.0, surface = 0.0;
  std::size_t tets = 0;
  double fit = std::numeric_limits<double>::quiet_NaN();  // [1] force error at the fitted depths
};

// Extent of the study.
struct FidelityPlan {
  std::vector<int> cells;                  // of the block, per punch radius
  std::vector<double> level_cells, focus;  // [m] of lattices: uniform, and fine only under the punch
  std::vector<double> split;               // [m] of uniform lattices with split contacts
  std::vector<double> lattice, lens;       // [1] radii per cell, small block: uniform, and fine under the punch only
  double seconds;                          // [s] of a press in a level
  std::vector<Shape> shapes;               // of P1
};
FidelityPlan fidelity_plan(StudySize size) {
  switch (size) {
    case StudySize::kFull:
      return {{2, 3, 4, 5},
              {0.01, 0.005, 0.01 / 3, 0.0025},
              {0.002, 0.001},
              {0.01, 0.02 / 3, 0.005, 0.004},
              {2.0, 1.0, 0.5, 1.0 / 3, 0.25, 2.0 / 9},
              {0.5, 0.25, 1.0 / 6},
              0.25,
              {Shape::kPunch, Shape::kHertz, Shape::kGaussian, Shape::kWendland, Shape::kVolume, Shape::kKelvinlet}};
    case StudySize::kQuick:
      return {{1, 2, 3},
              {0.01, 0.005},
              {0.002},
              {0.01, 0.02 / 3, 0.005},
              {2.0, 1.0, 0.5},
              {0.5},
              0.1,
              {Shape::kPunch, Shape::kHertz, Shape::kGaussian, Shape::kWendland, Shape::kVolume, Shape::kKelvinlet}};
    case StudySize::kSmall:
      break;
  }
  return {{1, 2, 3}, {0.01}, {0.004}, {0.01}, {2.0, 1.0}, {1.0}, 0.05, {Shape::kPunch, Shape::kGaussian}};
}

// A smaller block, in radii, so that fine lattices are affordable. Its width and thickness are whole numbers of cells
// for all lattices.
Indented small_block() {
  Indented what;
  what.half_width = 3 * what.radius;
  what.thickness = 2 * what.radius;
  what.depths = {0.001};
  return what;
}

class Fidelity {
 public:
  Fidelity(StudySize size, const Interrupt& interrupt)
      : plan_(fidelity_plan(size)), interrupt_(interrupt), progress_("study fidelity") {}

  Status run() {
    if (const Status done = find_truth(); !done) return done;
    if (const Status done = press_surfaces(); !done) return done;
    if (const Status done = press_bodies(); !done) return done;
    return press_lattices();
  }
  const std::vector<FidelityRow>& rows() const { return rows_; }
  const std::vector<FidelityRow>& lattice_rows() const { return lattice_rows_; }  // uniform ones first
  const FidelityRow& finest_even() const { return lattice_rows_[plan_.lattice.size() - 1]; }
  const std::string& truth_words() const { return truth_words_; }
  const std::string& truth_csv() const { return truth_csv_; }
  // [1] Radii per cell at which a uniform lattice's force error equals `error`, interpolated; NaN if no lattice reaches
  // it.
  double lattice_for(double error) const {
    for (std::size_t i = 0; i < plan_.lattice.size(); ++i) {
      if (lattice_rows_[i].force > error) continue;
      if (i == 0) return plan_.lattice[0];
      const double share = (lattice_rows_[i - 1].force - error) / (lattice_rows_[i - 1].force - lattice_rows_[i].force);
      return plan_.lattice[i - 1] + share * (plan_.lattice[i] - plan_.lattice[i - 1]);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  Status goes_on(double share) {
    if (interrupt_.requested()) return interrupted();
    progress_.update(share);
    return Done{};
  }

  Status find_truth() {
    std::vector<double> depths = what_.depths;
    depths.insert(depths.end(), what_.fit_depths.begin(), what_.fit_depths.end());
    depths.push_back(what_.radius / 100);  // small strains
    std::sort(depths.begin(), depths.end());
    GridPresses all;
    auto truths = limits_of(what_, plan_.cells, depths, all, interrupt_, progress_, 0.0, 0.6);
    if (!truths) return truths.error();
    const auto at = [&](double depth) -> const DepthTruth& {
      return *std::find_if(truths->begin(), truths->end(), [&](const DepthTruth& t) { return t.depth == depth; });
    };
    for (const double depth : what_.depths) truth_.force.push_back(at(depth).limit.limit);
    for (const double depth : what_.fit_depths) fit_force_.push_back(at(depth).limit.limit);
    judged_ = at(what_.depths.back()).limit_surface();
    fitted_to_ = at(what_.fit_depths[1]).limit_surface();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const PressTruth& its = at(what_.depths.back()).surface[i];
      const Indentation model = as_indentation(all[i], what_.depths);
      rows_.push_back({"FEM, fitted grid", fmt::format("FEM, {} tets", all[i].back().tets), model.us,
                       force_error(model, truth_), shape_error(its.share, judged_).profile, all[i].back().tets});
    }
    truth_words_ = fmt::format(
        "The truth is the limit of ever finer grids{}; the finest, of {} tetrahedra, is {:.2g} % from it in force and "
        "{:.2g} % in its surface",
        plan_.cells.size() > 3 ? fmt::format(" (known to {:.2g} %)", 100 * at(what_.depths.back()).sure) : "",
        rows_.back().tets, 100 * rows_.back().force, 100 * rows_.back().surface);
    truth_csv_ = pliant::truth_csv(plan_.cells, *truths, all);
    return Done{};
  }

  Status add_surface(const std::string& group, const std::string& label, const DeformableParameters& parameters,
                     double fit = std::numeric_limits<double>::quiet_NaN()) {
    auto model = press_surface(what_, parameters);
    if (!model) return model.error();
    rows_.push_back({group, label, model->us, force_error(*model, truth_), surface_error(*model, judged_), 0, fit});
    return goes_on(0.62);
  }

  Status press_surfaces() {
    DeformableParameters usual;
    usual.stiffness = calibrated_stiffness(what_.young, what_.poisson, what_.thickness);
    usual.reach = 5 * what_.radius;
    double least_row = 1e30, reach = 0.0;
    Shape nearest = Shape::kPunch;
    for (const Shape shape : plan_.shapes) {
      DeformableParameters its = usual;
      its.shape = shape;
      if (const Status done = add_surface("P1 from Young's modulus", word_of(shape), its); !done) return done;
      // For a half-space shape the contact radius is the punch's: the key `contact_radius`.
      for (double over = 1.1; over <= 8.0; over *= 1.05) {
        const double error = shape_error(engine_share(shape, what_.radius, over * what_.radius), fitted_to_).profile;
        if (error < least_row) least_row = error, nearest = shape, reach = over * what_.radius;
      }
    }
    for (const SpringLaw law : kFidelityLaws) {
      DeformableParameters its = usual;
      its.shape = Shape::kPunch;
      its.spring = law;
      if (const Status done = add_surface("P1 from Young's modulus", std::string("punch, ") + word_of(law), its); !done)
        return done;
    }
    usual.shape = nearest;
    usual.reach = reach;
    usual.contact_radius = depends_on_contact(nearest) ? what_.radius : 0.0;
    for (const SpringLaw law : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
      DeformableParameters its = usual;
      its.spring = law;
      its = fitted_law(its, what_.fit_depths, fit_force_);
      Indentation model, truth;
      truth.force = fit_force_;
      for (const double depth : what_.fit_depths) model.force.push_back(law_force(its, depth));
      const std::string label =
          fmt::format("{} {:.1f} a, {}, fitted", word_of(nearest), reach / what_.radius, word_of(law));
      if (const Status done = add_surface("P1, law and reach fitted", label, its, force_error(model, truth)); !done)
        return done;
    }
    return Done{};
  }

  Status press_bodies() {
    const struct {
      const char *group, *label;
      const std::vector<double>& cells;
      bool focus;
      SoftContact contact;
    } kinds[] = {{"FEM, in a level, plain", "plain", plan_.level_cells, false, SoftContact::kLattice},
                 {"FEM, in a level, focus", "focus", plan_.focus, true, SoftContact::kLattice},
                 {"FEM, in a level, split", "split", plan_.split, false, SoftContact::kSplit}};
    double done = 0.0;
    for (const auto& kind : kinds)
      for (const double cell : kind.cells) {
        PressRun press{cell, plan_.seconds, 0, [&] { return !interrupt_.requested(); }, kind.focus, kind.contact};
        auto model = press_tissue(what_, press);
        if (!model) return model.error();
        rows_.push_back({kind.group, fmt::format("{}, cell {:.3g} mm, {} tets", kind.label, 1000 * cell, press.tets),
                         model->us, force_error(*model, truth_), surface_error(*model, judged_), press.tets});
        const double all = static_cast<double>(plan_.level_cells.size() + plan_.focus.size() + plan_.split.size());
        if (const Status on = goes_on(0.62 + 0.13 * (done += 1.0) / all); !on) return on;
      }
    return Done{};
  }

  // Lattice resolution that a contact needs.
  Status press_lattices() {
    const Indented what = small_block();
    GridPresses all;
    const auto truths = limits_of(what, plan_.cells, what.depths, all, interrupt_, progress_, 0.75, 0.05);
    if (!truths) return truths.error();
    Indentation truth;
    truth.force = {truths->back().limit.limit};
    double done = 0.0, whole = 0.0;
    for (const double radii : plan_.lattice) whole += std::pow(radii, -4);
    for (const bool focus : {false, true})
      for (const double radii : focus ? plan_.lens : plan_.lattice) {
        PressRun press{radii * what.radius, std::min(plan_.seconds, kLatticeSeconds), 0,
                       [&] { return !interrupt_.requested(); }, focus};
        auto model = press_tissue(what, press);
        if (!model) return model.error();
        lattice_rows_.push_back({focus ? "focus" : "even", fmt::format("{:.3g}", radii), model->us,
                                 force_error(*model, truth), surface_error(*model, truths->back().limit_surface()),
                                 press.tets});
        if (!focus) done += std::pow(radii, -4) / whole;
        if (const Status on = goes_on(0.8 + 0.18 * done); !on) return on;
      }
    return Done{};
  }

  FidelityPlan plan_;
  const Interrupt& interrupt_;
  Progress progress_;
  Indented what_;
  Indentation truth_;              // at what_.depths
  std::vector<double> fit_force_;  // [N] at what_.fit_depths
  PressTruth judged_, fitted_to_;  // surfaces at the judged and at the fitted depths
  std::string truth_words_, truth_csv_;
  std::vector<FidelityRow> rows_, lattice_rows_;
};

ParetoTable table_of(const std::vector<FidelityRow>& rows, const std::string& name, const std::string& what,
                     const std::function<double(const FidelityRow&)>& error) {
  ParetoTable table;
  table.study = name;
  table.title = "a punch of 4 mm radius goes up to 1.5 mm into 20 mm of bonded tissue: " + what + " by every model";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us of processor time a tick of 1 ms, soft steps of 1/60 s shared out]";
  table.error_name = "error";
  table.error_axis = what + ", RMS over RMS of the truth [1]";
  table.more = {"tetrahedra", "force_error", "surface_error", "force_error_where_fitted"};
  table.joined = false;
  for (const FidelityRow& row : rows)
    table.rows.push_back({row.label,
                          row.us,
                          error(row),
                          row.group,
                          {static_cast<std::int64_t>(row.tets), row.force, row.surface, row.fit}});
  return table;
}

// CSV of the lattices: radii per cell.
std::string lattice_csv(const std::vector<FidelityRow>& rows) {
  std::string csv = "lattice,cell_over_radius,tetrahedra,force_error,surface_error,cost_us\n";
  for (const FidelityRow& row : rows)
    csv +=
        fmt::format("{},{},{},{:.9g},{:.9g},{:.6g}\n", row.group, row.label, row.tets, row.force, row.surface, row.us);
  return csv;
}

const FidelityRow& least_row(const std::vector<FidelityRow>& rows, const std::string& group) {
  // Of rows with equal larger error, the one with the smaller other error is first.
  const auto order = [](const FidelityRow& row) {
    return std::pair(largest(row.force, row.surface), row.force + row.surface);
  };
  const FidelityRow* best = nullptr;
  for (const FidelityRow& row : rows)
    if (row.group.starts_with(group) && (!best || order(row) < order(*best))) best = &row;
  return *best;
}

std::string words(const FidelityRow& row) {
  return fmt::format("{} ({} % force, {} % surface, {} us a tick)", row.label, two_digits(100 * row.force),
                     two_digits(100 * row.surface), two_digits(row.us));
}

// Lattice needed for errors of 20 and 10 %, or the error of the finest.
std::string lattice_words(const Fidelity& study) {
  std::string out;
  for (const double error : {0.2, 0.1})
    if (const double radii = study.lattice_for(error); std::isfinite(radii))
      out += fmt::format("{} {:.2g} radii for {:g} %", out.empty() ? "needs cells of" : " and", radii, 100 * error);
  const FidelityRow& finest = study.finest_even();
  if (!std::isfinite(study.lattice_for(0.1)))
    out += fmt::format("{} off by {} % with cells of {} radii", out.empty() ? "is" : ", and is",
                       two_digits(100 * finest.force), finest.label);
  return out;
}

std::vector<std::string> sentences(const Fidelity& study) {
  const std::vector<FidelityRow>& rows = study.rows();
  return {
      "The nearest of each kind, at depths that no law was fitted at: " + words(least_row(rows, "P1 from")) + "; " +
          words(least_row(rows, "P1, law")) + "; " + words(least_row(rows, "FEM, in")) + "; " +
          words(least_row(rows, "FEM, fitted")) + ".",
      study.truth_words() + fmt::format("; in an even lattice, on a block of 3 radii about the punch, the force {}.",
                                        lattice_words(study))};
}

}  // namespace

Status study_fidelity(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Fidelity study(size, interrupt);
  if (const Status done = study.run(); !done) return done;
  const std::vector<FidelityRow>& rows = study.rows();
  const std::vector<std::string> said = sentences(study);
  ParetoTable both = table_of(rows, "fidelity", "the larger error of force and surface",
                              [](const FidelityRow& row) { return largest(row.force, row.surface); });
  both.sentences = said;
  for (const auto& [part, what, error] : {std::tuple{"fidelity_force", "force error", &FidelityRow::force},
                                          std::tuple{"fidelity_surface", "surface error", &FidelityRow::surface}}) {
    const ParetoTable one = table_of(rows, part, what, [error = error](const FidelityRow& row) { return row.*error; });
    if (const Status done = plot_pareto(out, part, one); !done) return done;
  }
  if (const Status done = write_text(out, "fidelity_truth.csv", study.truth_csv()); !done) return done;
  if (const Status done = write_text(out, "fidelity_lattice.csv", lattice_csv(study.lattice_rows())); !done)
    return done;
  return write_study(out, both);
}

}  // namespace pliant
