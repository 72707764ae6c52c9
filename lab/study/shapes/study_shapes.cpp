#include "lab/study/shapes/study_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/keys/extensions.h"
#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/csv.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "runtime/assert.h"
#include "systems/touch/model/contact_law.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPressRadius = 0.004;  // [m] of the punch for which the engine calibrates stiffness
constexpr double kAround = 5.0;         // [1] radii within which profiles are compared
constexpr double kUsual = 5.0;          // [1] default reach over the contact radius (force_field.cpp)
constexpr Shape kShapes[] = {Shape::kPunch,    Shape::kHertz,  Shape::kGaussian,
                             Shape::kWendland, Shape::kVolume, Shape::kKelvinlet};

FieldSource source_of(Shape shape, double inner, double reach) {
  FieldSource source;
  source.amplitude = 1.0f;
  source.inv_reach2 = static_cast<float>(1 / (reach * reach));
  source.shape = shape;
  source.parameter = shape_parameter(shape, inner, reach, 1.0);
  return source;
}

// [ns] per vertex whose target is computed, in the engine's kernel.
double measure(Shape shape, int batches) {
  Mesh mesh;
  mesh.vertex_count = kZoneSize;
  mesh.nx.assign(kZoneSize, 0.0f);
  mesh.ny.assign(kZoneSize, 1.0f);
  mesh.nz = mesh.py = mesh.nx;
  for (std::uint32_t v = 0; v < kZoneSize; ++v) {
    mesh.px.push_back(1e-3f * static_cast<float>(v % 12));
    mesh.pz.push_back(1e-3f * static_cast<float>(v / 12));
  }
  const FieldSource source = source_of(shape, kPressRadius, kUsual * kPressRadius);
  ZoneTargets targets{};
  double least = 1e30;
  for (int i = 0; i < batches; ++i) {
    const std::uint64_t begin = processor_ns();
    for (int k = 0; k < 200; ++k) add_targets(mesh, 0, source, true, targets);
    least = std::min(least, static_cast<double>(processor_ns() - begin) / (200.0 * kZoneSize));
  }
  return least;
}

// P1's calibrated force against a reference at the same depth.
struct ForceRow {
  std::string truth;
  bool by_construction = false;           // the law is this closed form
  double model = 0.0, truth_force = 0.0;  // [N]
  // Of a block.
  double bonded = std::numeric_limits<double>::quiet_NaN();  // [N] the law times the bonding factor of a half-space
  std::int64_t tets = 0;                                     // of the finest grid
  double finest = std::numeric_limits<double>::quiet_NaN();  // [N] force on it; `truth_force`: the limit
  double order = std::numeric_limits<double>::quiet_NaN();   // [1] order of convergence of the grids
  double finest_profile = std::numeric_limits<double>::quiet_NaN();  // [1] profile error of its surface
  double error() const { return model / truth_force - 1; }
};

struct Blocks {
  std::vector<PressTruth> truths;
  std::vector<ForceRow> forces;
};

// [1] Force on a bonded over that on a frictionless flat punch on a half-space (Mossakovskii, Spence).
double bonding(double poisson) {
  return (1 - poisson) * std::log(3 - 4 * poisson) / (1 - 2 * poisson);
}

Result<Blocks> press_blocks(StudySize size, const Interrupt& interrupt, Progress& progress) {
  Blocks out;
  struct Slab {
    double thickness, poisson;
  };
  const std::vector<Slab> slabs = size != StudySize::kFull
                                      ? std::vector<Slab>{{2, 0.45}}
                                      : std::vector<Slab>{{10, 0.3}, {2, 0.3}, {2, 0.45}, {2, 0.49}, {1, 0.45}};
  const std::vector<int> cells = size == StudySize::kFull    ? std::vector{4, 5, 6}
                                 : size == StudySize::kQuick ? std::vector{2, 3, 4}
                                                             : std::vector{1, 2, 3};
  constexpr double kYoung = 10e3, kDepth = 1e-4;
  double done = 0.0;
  for (const Slab& slab : slabs) {
    const std::string name = fmt::format("block {:g} a thick, Poisson {:g}", slab.thickness, slab.poisson);
    std::vector<PressedBlock> blocks;
    std::vector<double> forces;
    for (const int n : cells) {
      if (interrupt.requested()) return interrupted();
      auto block = press_block(
          {kYoung, slab.poisson, kPressRadius, slab.thickness * kPressRadius, 10 * kPressRadius, n}, kDepth);
      if (!block) return block.error();
      forces.push_back(block->force);
      blocks.push_back(std::move(*block));
      progress.update((done += 1.0) / static_cast<double>(slabs.size() * cells.size()));
    }
    const GridLimit limit = grid_limit(cells, forces);
    const PressTruth finest = block_truth(name, kPressRadius, blocks.back()),
                     coarser = block_truth(name, kPressRadius, blocks[blocks.size() - 2]);
    ForceRow row{name};
    row.model = calibrated_stiffness(kYoung, slab.poisson, slab.thickness * kPressRadius) * kDepth;
    row.truth_force = limit.limit;
    row.bonded = row.model * bonding(slab.poisson);
    row.tets = static_cast<std::int64_t>(blocks.back().tets);
    row.finest = forces.back();
    row.order = limit.order;
    out.truths.push_back(limit_truth(coarser, finest, limit));
    row.finest_profile = shape_error(finest.share, out.truths.back()).profile;
    out.forces.push_back(row);
  }
  return out;
}

void add_laws(std::vector<ForceRow>& rows) {
  Deformable d;
  d.young = 10e3;
  d.stiffness = calibrated_stiffness(d.young, d.poisson, 0.0);
  const double plane = d.young / (1 - d.poisson * d.poisson), depth = 1e-3, ball = 0.008;
  const Motion m = motion(d, 1e-3);
  rows.push_back(
      {"half-space, punch", true, contact_law(d, m, 1.0, 0.0).force(depth), 2 * plane * kPressRadius * depth});
  rows.push_back({"half-space, sphere", true, contact_law(d, m, 1.0, ball).force(depth),
                  4.0 / 3.0 * plane * std::sqrt(ball) * depth * std::sqrt(depth)});
}

std::string csv_of(const std::vector<ForceRow>& rows) {
  std::string csv =
      "truth,by_construction,model_N,true_N,force_error,model_bonded_N,finest_tetrahedra,finest_N,order,finest_profile_"
      "error\n";
  for (const ForceRow& row : rows) {
    csv += csv_text(row.truth) + (row.by_construction ? ",1" : ",0");
    for (const double value : {row.model, row.truth_force, row.error()}) put(csv, value);
    if (row.by_construction) {
      csv += ",,,,,\n";
      continue;
    }
    put(csv, row.bonded);
    csv += fmt::format(",{}", row.tets);
    put(csv, row.finest);
    csv += std::isfinite(row.order) ? fmt::format(",{:.3g}", row.order) : ",";
    put(csv, row.finest_profile);
    csv += '\n';
  }
  return csv;
}

// True if the reference is the shape's own closed form.
bool by_construction(const PressTruth& truth, Shape shape) {
  return (truth.name == "half-space, punch" && shape == Shape::kPunch) ||
         (truth.name == "half-space, sphere" && shape == Shape::kHertz);
}

// The plot shows four references; the table has all.
bool is_drawn(const std::string& truth) {
  return truth.starts_with("half") || truth == "block 10 a thick, Poisson 0.3" ||
         truth == "block 2 a thick, Poisson 0.45";
}

std::string nearest_of(const ParetoTable& table) {
  std::string out, exact;
  for (std::size_t i = 0; i < table.rows.size();) {
    const std::string& truth = table.rows[i].group;
    const ParetoRow* least = nullptr;
    for (; i < table.rows.size() && table.rows[i].group == truth; ++i)
      if (std::get<std::string>(table.rows[i].more[0]) == "best" && (!least || table.rows[i].error < least->error))
        least = &table.rows[i];
    if (std::get<bool>(least->more[3]))
      exact += fmt::format("{}{}", exact.empty() ? "" : " and ", least->label);
    else
      out += fmt::format("{}{}, {} ({:.2g} %)", out.empty() ? "" : "; ", truth, least->label, 100 * least->error);
  }
  return "The nearest shape to each block's surface, with its reach in contact radii: " + out + "; on a half-space " +
         exact + " are exact by construction, with these reaches or longer ones.";
}

std::string forces_of(const std::vector<ForceRow>& rows) {
  const ForceRow *low = nullptr, *high = nullptr;
  double off = 0.0, profile = 0.0, bonded = 0.0;
  for (const ForceRow& row : rows) {
    if (row.by_construction) continue;
    if (!low || row.error() < low->error()) low = &row;
    if (!high || row.error() > high->error()) high = &row;
    off = std::max(off, std::abs(row.finest / row.truth_force - 1));
    profile = std::max(profile, row.finest_profile);
    bonded = std::max(bonded, std::abs(row.bonded / row.truth_force - 1));
  }
  std::string range = fmt::format("{:+.1f} % ({})", 100 * low->error(), low->truth);
  if (high != low) range += fmt::format(" to {:+.1f} % ({})", 100 * high->error(), high->truth);
  return fmt::format(
      "The calibrated law's force is off by {} of the limit of ever finer grids, and by "
      "{:.1f} % at most with what bonding adds on a half-space; the finest grids themselves are off by up to {:.1f} % "
      "in "
      "force and {:.1f} % in their surface.",
      range, 100 * bonded, 100 * off, 100 * profile);
}

}  // namespace

const char* name_of(Shape shape) {
  return row_of(shape).word;
}

PressTruth punch_truth(double a) {
  return {"half-space, punch", a, [a](double r) { return r <= a ? 1.0 : 2 / kPi * std::asin(a / r); }};
}

PressTruth hertz_truth(double a) {
  return {"half-space, sphere", a, [a](double r) {
            const double q = r / a;
            if (q <= 1) return 1 - q * q / 2;
            return ((2 - q * q) * std::asin(1 / q) + std::sqrt(q * q - 1)) / kPi;
          }};
}

PressTruth block_truth(const std::string& name, double radius, const PressedBlock& block) {
  return {name, radius, [radius = block.radius, share = block.share](double r) {
            const auto above = std::upper_bound(radius.begin(), radius.end(), r);
            if (above == radius.end()) return share.back();
            if (above == radius.begin()) return share.front();
            const auto i = static_cast<std::size_t>(above - radius.begin());
            const double t = (r - radius[i - 1]) / (radius[i] - radius[i - 1]);
            return share[i - 1] + t * (share[i] - share[i - 1]);
          }};
}

PressTruth limit_truth(const PressTruth& coarser, const PressTruth& finest, const GridLimit& force) {
  return {finest.name, finest.inner, [coarse = coarser.share, fine = finest.share, more = force.to_come](double r) {
            return fine(r) + more * (fine(r) - coarse(r));
          }};
}

std::function<double(double)> engine_share(Shape shape, double inner, double reach) {
  const FieldSource source = source_of(shape, inner, reach);
  return [source, reach](double r) {
    if (r >= reach) return 0.0;
    return static_cast<double>(share_at(source, vec3(static_cast<float>(r), 0, 0), vec3(0, 1, 0)));
  };
}

ShapeError shape_error(const std::function<double(double)>& share, const PressTruth& truth) {
  constexpr int kParts = 2000;
  const double step = kAround * truth.inner / kParts;
  double off = 0.0, size = 0.0, net = 0.0, true_net = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double r = (i + 0.5) * step, f = share(r), u = truth.share(r);
    off += (f - u) * (f - u) * r;
    size += u * u * r;
    net += f * r;
    true_net += u * r;
  }
  return {std::sqrt(off / size), net / true_net - 1};
}

double best_reach(Shape shape, const PressTruth& truth) {
  const auto error = [&](double over) {
    return shape_error(engine_share(shape, truth.inner, over * truth.inner), truth).profile;
  };
  double least = 1e30;
  for (double over = 1.0; over < 40.0; over *= 1.02) least = std::min(least, error(over));
  // The smallest reach whose error is within a thousandth of the minimum, so that rounding does not decide.
  for (double over = 1.0; over < 40.0; over *= 1.02)
    if (error(over) <= 1.001 * least + 1e-6) return over * truth.inner;
  UNREACHABLE();
}

Status study_shapes(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Progress progress("study shapes");
  auto blocks = press_blocks(size, interrupt, progress);
  if (!blocks) return blocks.error();
  std::vector<PressTruth> truths{punch_truth(kPressRadius), hertz_truth(kPressRadius)};
  truths.insert(truths.end(), blocks->truths.begin(), blocks->truths.end());
  add_laws(blocks->forces);

  ParetoTable table;
  table.study = "shapes";
  table.title =
      "the surface of a press, by each shape at its best reach, against closed forms and blocks of tetrahedra";
  table.cost_name = "cost_ns_per_vertex";
  table.cost_axis = "cost [ns a vertex reached]";
  table.error_name = "profile_error";
  table.error_axis = "profile error: RMS difference over RMS [1]";
  table.more = {"reach", "reach_over_radius", "volume_error", "by_construction"};
  table.joined = false;
  table.front_by_group = true;
  table.least_error = 0.01;
  table.most_error = 1.0;
  std::vector<double> ns;
  for (const Shape shape : kShapes) ns.push_back(measure(shape, size == StudySize::kFull ? 101 : 9));
  for (const PressTruth& truth : truths)
    for (const bool best : {true, false})
      for (std::size_t i = 0; i < std::size(kShapes); ++i) {
        const double reach = best ? best_reach(kShapes[i], truth) : kUsual * truth.inner;
        const ShapeError error = shape_error(engine_share(kShapes[i], truth.inner, reach), truth);
        if (best && is_drawn(truth.name)) table.drawn.push_back(table.rows.size());
        table.rows.push_back(
            {fmt::format("{} {:.1f} a", name_of(kShapes[i]), reach / truth.inner),
             ns[i],
             error.profile,
             truth.name,
             {best ? "best" : "usual", reach / truth.inner, error.volume, best && by_construction(truth, kShapes[i])}});
      }
  table.sentences.push_back(nearest_of(table));
  table.sentences.push_back(forces_of(blocks->forces));
  if (const Status done = write_text(out, "shapes_force.csv", csv_of(blocks->forces)); !done) return done;
  return write_study(out, table);
}

}  // namespace pliant
