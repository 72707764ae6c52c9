#include "player/study/study_fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/enum_words.h"
#include "content/keys/extensions.h"
#include "player/progress.h"
#include "player/study/studies.h"

namespace pliant {
namespace {

constexpr double kFieldAround = 5.0;  // [1] radii that a surface is compared over
constexpr Shape kFidelityShapes[] = {Shape::kPunch,    Shape::kHertz,  Shape::kGaussian,
                                     Shape::kWendland, Shape::kVolume, Shape::kKelvinlet};
constexpr SpringLaw kFidelityLaws[] = {SpringLaw::kCubic, SpringLaw::kExponential, SpringLaw::kStandardLinearSolid};

double largest(double a, double b) {
  return std::max(a, b);
}

// One model's row in three tables: the larger error, the force's, the surface's.
struct FidelityRow {
  std::string group, label;
  double us = 0.0, force = 0.0, surface = 0.0;
  std::size_t tets = 0;
  double cell = 0.0;  // [m] of a level's lattice
};

class Fidelity {
 public:
  Fidelity(bool quick, const Interrupt& interrupt)
      : quick_(quick), interrupt_(interrupt), progress_("study fidelity") {}

  Status run() {
    if (const Status done = find_truth(); !done) return done;
    if (const Status done = press_surfaces(); !done) return done;
    return press_bodies();
  }
  const std::vector<FidelityRow>& rows() const { return rows_; }
  std::string truth_words() const { return truth_words_; }

 private:
  Status goes_on(double share) {
    if (interrupt_.requested()) return interrupted();
    progress_.update(share);
    return Done{};
  }

  Status find_truth() {
    const std::vector<int> cells = quick_ ? std::vector<int>{1, 2} : std::vector<int>{1, 2, 3, 4, 5};
    double done = 0.0;
    std::vector<std::vector<PressedBlock>> all;
    for (const int n : cells) {
      auto pressed = press_block(what_.block(n), what_.depths);
      if (!pressed) return pressed.error();
      all.push_back(std::move(*pressed));
      if (const Status on = goes_on(0.5 * (done += 1.0) / static_cast<double>(cells.size())); !on) return on;
    }
    truth_ = as_indentation(all.back());
    shares_ = block_truth("finest", what_.radius, all.back().back());
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      const PressTruth its = block_truth("block", what_.radius, all[i].back());
      const Indentation model = as_indentation(all[i]);
      rows_.push_back({"FEM, fitted grid", fmt::format("FEM, {} tets", all[i].back().tets), model.us,
                       force_error(model, truth_), shape_error(its.share, shares_).profile, all[i].back().tets});
    }
    const FidelityRow& next = rows_.back();
    truth_words_ = fmt::format(
        "The truth has {} tetrahedra; the next coarser block, {}, is off by {:.2g} % in force "
        "and {:.2g} % in its surface",
        all.back().back().tets, next.tets, 100 * next.force, 100 * next.surface);
    return Done{};
  }

  Status add_surface(const std::string& group, const std::string& label, const DeformableParameters& parameters) {
    auto model = press_surface(what_, parameters);
    if (!model) return model.error();
    rows_.push_back({group, label, model->us, force_error(*model, truth_), surface_error(*model, shares_)});
    return goes_on(0.55);
  }

  Status press_surfaces() {
    DeformableParameters usual;
    usual.stiffness = calibrated_stiffness(what_.young, what_.poisson, what_.thickness);
    usual.reach = 5 * what_.radius;
    double least_row = 1e30, reach = 0.0;
    Shape nearest = Shape::kPunch;
    for (const Shape shape : kFidelityShapes) {
      DeformableParameters its = usual;
      its.shape = shape;
      if (const Status done = add_surface("P1 from Young's modulus", word_of(shape), its); !done) return done;
      // Of a half-space shape the contact radius is the punch's: the key `contact_radius`.
      for (double over = 1.1; over <= 8.0; over *= 1.05) {
        const double error = shape_error(engine_share(shape, what_.radius, over * what_.radius), shares_).profile;
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
      its = fitted_law(its, what_, truth_);
      const std::string label =
          fmt::format("{} {:.1f} a, {}, fitted", word_of(nearest), reach / what_.radius, word_of(law));
      if (const Status done = add_surface("P1, law and reach fitted", label, its); !done) return done;
    }
    return Done{};
  }

  Status press_bodies() {
    const std::vector<double> cells =
        quick_ ? std::vector<double>{0.008, 0.006} : std::vector<double>{0.008, 0.006, 0.004, 0.003};
    double done = 0.0;
    for (const double cell : cells) {
      PressWish press{cell, quick_ ? 0.1 : 0.25};
      auto model = press_tissue(what_, press);
      if (!model) return model.error();
      rows_.push_back({"FEM, in a level", fmt::format("level, cell {:g} mm, {} tets", 1000 * cell, press.tets),
                       model->us, force_error(*model, truth_), surface_error(*model, shares_), press.tets, cell});
      if (const Status on = goes_on(0.6 + 0.4 * (done += 1.0) / static_cast<double>(cells.size())); !on) return on;
    }
    return Done{};
  }

  bool quick_;
  const Interrupt& interrupt_;
  Progress progress_;
  Indented what_;
  Indentation truth_;
  PressTruth shares_;
  std::string truth_words_;
  std::vector<FidelityRow> rows_;
};

ParetoTable table_of(const std::vector<FidelityRow>& rows, const std::string& name, const std::string& what,
                     const std::function<double(const FidelityRow&)>& error) {
  ParetoTable table;
  table.study = name;
  table.title = "a punch of 4 mm goes up to 2 mm into 20 mm of bonded tissue: " + what + " by every model";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us of processor time a tick of 1 ms, soft steps of 1/60 s shared out]";
  table.error_name = "error";
  table.error_axis = what + ", RMS over RMS of the finest FEM [1]";
  table.more = {"tetrahedra", "force_error", "surface_error"};
  table.joined = false;
  for (const FidelityRow& row : rows)
    table.rows.push_back(
        {row.label,
         row.us,
         error(row),
         row.group,
         {std::to_string(row.tets), fmt::format("{:.9g}", row.force), fmt::format("{:.9g}", row.surface)}});
  return table;
}

const FidelityRow& least_row(const std::vector<FidelityRow>& rows, const std::string& group) {
  // Of those whose worse error is the same, the one whose other error is less.
  const auto order = [](const FidelityRow& row) {
    return std::pair(largest(row.force, row.surface), row.force + row.surface);
  };
  const FidelityRow* best = nullptr;
  for (const FidelityRow& row : rows)
    if (row.group.starts_with(group) && (!best || order(row) < order(*best))) best = &row;
  return *best;
}

std::string words(const FidelityRow& row) {
  return fmt::format("{} ({:.2g} % force, {:.2g} % surface, {:.2g} us a tick)", row.label, 100 * row.force,
                     100 * row.surface, row.us);
}

// [1] of the best level's lattice, over the punch's radius.
double cells_of(const std::vector<FidelityRow>& rows) {
  return least_row(rows, "FEM, in").cell / Indented{}.radius;
}

std::vector<std::string> sentences(const Fidelity& study) {
  const std::vector<FidelityRow>& rows = study.rows();
  return {"The nearest of each kind: " + words(least_row(rows, "P1 from")) + "; " + words(least_row(rows, "P1, law")) +
              "; " + words(least_row(rows, "FEM, in")) + "; " + words(least_row(rows, "FEM, fitted")) + ".",
          study.truth_words() +
              fmt::format(". Those grids are fine under the punch; a level's lattice is even, and with cells "
                          "of {:.2g} radii its force is off by {:.2g} %.",
                          cells_of(rows), 100 * least_row(rows, "FEM, in").force)};
}

}  // namespace

double force_error(const Indentation& model, const Indentation& truth) {
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < truth.force.size(); ++i) {
    off += (model.force[i] - truth.force[i]) * (model.force[i] - truth.force[i]);
    size += truth.force[i] * truth.force[i];
  }
  return std::sqrt(off / size);
}

double surface_error(const Indentation& model, const PressTruth& truth) {
  double off = 0.0, size = 0.0;
  for (const auto& [r, share] : model.surface) {
    if (r > kFieldAround * truth.inner) continue;
    const double u = truth.share(r);
    off += (share - u) * (share - u);
    size += u * u;
  }
  return std::sqrt(off / size);
}

DeformableParameters fitted_law(DeformableParameters law, const Indented& what, const Indentation& truth) {
  // The force is linear in k: F = k g(d). The shape of g, k3/k or alpha, from a list; k by least squares.
  const auto g = [&](double shape, double d) {
    switch (law.spring) {
      case SpringLaw::kCubic:
        return d + shape * d * d * d;
      case SpringLaw::kExponential:
        return std::expm1(shape * d) / shape;
      default:
        return d;
    }
  };
  const double unit = 1 / what.depths.back();
  double least_row = 1e300;
  for (int i = 0; i <= 121; ++i) {
    // [1] over the deepest; the exponential law may soften, too.
    const double stiffening = (i % 2 ? -1 : 1) * 1e-3 * std::pow(10.0, i / 2 / 15.0);
    if (stiffening < 0 && law.spring != SpringLaw::kExponential) continue;
    const double shape = law.spring == SpringLaw::kCubic ? stiffening * unit * unit : stiffening * unit;
    double up = 0.0, down = 0.0, off = 0.0;
    for (std::size_t k = 0; k < what.depths.size(); ++k) {
      const double x = g(shape, what.depths[k]);
      up += x * truth.force[k], down += x * x;
    }
    for (std::size_t k = 0; k < what.depths.size(); ++k) {
      const double e = up / down * g(shape, what.depths[k]) - truth.force[k];
      off += e * e;
    }
    if (!(off < least_row)) continue;
    least_row = off;
    law.stiffness = up / down;
    if (law.spring == SpringLaw::kCubic) law.cubic = shape * law.stiffness;
    if (law.spring == SpringLaw::kExponential) law.stiffening = shape;
    if (law.spring == SpringLaw::kLinear) break;
  }
  return law;
}

Status study_fidelity(OutputFolder& out, bool quick, const Interrupt& interrupt) {
  Fidelity study(quick, interrupt);
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
  return write_study(out, both);
}

}  // namespace pliant
