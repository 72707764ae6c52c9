#include "lab/study/coupling/study_coupling.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/console/progress.h"
#include "lab/files/csv.h"
#include "lab/study/heat_map.h"
#include "lab/study/pareto.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"

namespace pliant {
namespace {

constexpr double kCouplingWide = 0.02;     // [m] of the bar, and the handle's length
constexpr double kCouplingYoung = 2e4;     // [Pa]
constexpr double kCouplingBeta = 2e-3;     // [s] damping of its stiffness
constexpr double kCouplingPush = 0.1;      // [m/s] of its end
constexpr double kStable = 1.02;            // [1] of the second half over the first that still counts as stable
constexpr double kCouplingDiverged = 1e3;  // [1] of the tissue's own swing
constexpr double kResolved = 1e-6;         // [1] smaller differences are drawn as this
const Handle6 kHand;                       // its spring and damper hold the handle

SoftBody tissue_of_bar() {
  SoftBody body;
  body.young = kCouplingYoung;
  body.poisson = 0.4;
  body.rayleigh = {0.0, kCouplingBeta};
  return body;
}

TetMesh coupled_mesh(int cells) {
  const int across = std::max(1, cells / 3);
  return tets::box(cells, across, across, dvec3(0), {3.0 * kCouplingWide, kCouplingWide, kCouplingWide});
}

bool in_handle(dvec3 x) {
  return x.x < kCouplingWide * (1.0 + 1e-6);
}

Eigen::MatrixXd diagonal(const Eigen::VectorXd& v) {
  return v.asDiagonal();
}

// M v' + D v + K x = 0 of tissue and handle together.
struct Whole {
  Eigen::MatrixXd mass, damping, stiffness;
};

void add_hand(Whole& of) {
  for (int k = 0; k < 6; ++k) {
    const auto& pair = k < 3 ? kHand.translation : kHand.rotation;
    const Eigen::Index row = of.mass.rows() - 6 + k;
    of.stiffness(row, row) += pair[0], of.damping(row, row) += pair[1];
  }
}

// Steps of implicit Euler. Staggered: the tissue with the handle's last velocity, then the handle with the force of the
// tissue's new motion, which does not change as the handle yields: its own inertia and the hand are all that resist.
std::vector<double> steps_of(const Whole& of, bool staggered, Eigen::VectorXd v, double T, int steps) {
  const Eigen::Index n = v.size(), tissue = n - 6;
  const Eigen::MatrixXd A = of.mass + T * of.damping + T * T * of.stiffness;
  Eigen::MatrixXd own = of.mass.bottomRightCorner(6, 6);
  for (int k = 0; k < 6; ++k)
    own(k, k) += k < 3 ? T * kHand.translation[1] + T * T * kHand.translation[0]
                       : T * kHand.rotation[1] + T * T * kHand.rotation[0];
  const Eigen::PartialPivLU<Eigen::MatrixXd> whole(A), of_tissue(A.topLeftCorner(tissue, tissue)), of_handle(own);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<double> out;
  double half[2] = {0.0, 0.0};  // [J] largest energy of each half
  for (int i = 0; i < steps; ++i) {
    double& most = half[i < steps / 2 ? 0 : 1];
    most = std::max(most, 0.5 * (v.dot(of.mass * v) + x.dot(of.stiffness * x)));
    const Eigen::VectorXd right = of.mass * v - T * (of.stiffness * x);
    if (staggered) {
      const Eigen::VectorXd w = v.tail(6);
      v.head(tissue) = of_tissue.solve(right.head(tissue) - A.topRightCorner(tissue, 6) * w);
      const Eigen::VectorXd rest = A.bottomRightCorner(6, 6) * w - own * w;
      v.tail(6) = of_handle.solve(right.tail(6) - A.bottomLeftCorner(6, tissue) * v.head(tissue) - rest);
    } else {
      v = whole.solve(right);
    }
    x += T * v;
    out.push_back(x[n - 6 + 1]);
    if (!(x.cwiseAbs().maxCoeff() < kCouplingDiverged)) return {};
  }
  if (!(half[1] <= kStable * half[0])) return {};
  return out;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// [ms] of CPU time of the engine's step of a larger bar.
double coupling_ms(Coupled way, int cells, int rounds) {
  scenes::ToolStage stage(1.0 / 60.0);
  TetMesh mesh = coupled_mesh(cells);
  Handle6 handle = kHand;
  handle.attachment = way == Coupled::kSprings ? Attachment::kSpring : Attachment::kSlave;
  const bool together = way == Coupled::kSlaved || way == Coupled::kSprings;
  const auto never = [](dvec3) { return false; };
  if (together) tets::hold(mesh, never, in_handle);
  if (way == Coupled::kStaggeredSlaved) tets::hold(mesh, in_handle);
  const Entity bar = stage.add_soft(std::move(mesh), tissue_of_bar(), {}, together ? &handle : nullptr);
  stage.prepare();
  SoftBodyState& tissue = stage.tissue(bar);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < rounds; ++i) {
    const std::uint64_t begin = processor_ns();
    tissue.free_step(1.0 / 60.0, dvec3(0));
    least = std::min(least, static_cast<double>(processor_ns() - begin) * 1e-6);
  }
  return least;
}

struct CouplingGrid {
  std::vector<double> steps{1e-3, 4e-3, 1.0 / 60.0}, ties, heaviness;
  int cells = 6, count = 400;    // of the bar that swings, and its steps
  int costed = 18, rounds = 10;  // cells of the bar whose cost is measured
};

CouplingGrid grid_of(StudySize size) {
  CouplingGrid out;
  const int per_decade = size == StudySize::kFull ? 3 : 1;
  if (size == StudySize::kSmall) out.cells = 3, out.count = 100, out.costed = 6, out.rounds = 1;
  for (int i = 0; i <= 4 * per_decade; ++i) out.ties.push_back(std::pow(10.0, double(i) / per_decade));
  for (int i = -2 * per_decade; i <= 2 * per_decade; ++i)
    out.heaviness.push_back(std::pow(10.0, double(i) / per_decade));
  return out;
}

std::string sentence_of_stability(const std::vector<ParetoRow>& rows) {
  std::string out = "Share of cases (tie stiffness, mass ratio) that are unstable, by step:";
  for (const ParetoRow& row : rows)
    out += fmt::format("{} {} {} {:.0f} %", out.ends_with(':') ? "" : ",", row.group, row.label,
                       100.0 * std::get<double>(row.more[1]));
  return out + ".";
}

struct CouplingTable {
  HeatMaps maps;
  ParetoTable table;
  std::string csv = "way,step_s,tie,mass_ratio,difference\n";
  std::vector<double> ms;  // of each way's step
};

CouplingTable empty_table(const CouplingGrid& grid) {
  CouplingTable out;
  HeatMaps& maps = out.maps;
  maps.title = "coupling of tissue and handle: where it is stable, and how exact";
  maps.line = "A bar of 60 mm, a third of it rigid, swings in the hand's spring. Rows: length of the step.";
  maps.across = "stiffness of the springs between nodes and handle, of the tissue's [1]";
  maps.up = "mass of the handle over that of the tissue [1]";
  maps.tone = "RMS difference of the handle's motion from slaved nodes, implicit [1]";
  maps.failed = "unstable";
  maps.x = grid.ties, maps.y = grid.heaviness, maps.columns = kCoupledWays.size();
  ParetoTable& table = out.table;
  table.study = "coupling";
  table.title = "tissue and handle in one system or one after the other, nodes slaved or on springs";
  table.cost_name = "cost_us_per_ms";
  table.cost_axis = "cost [us of processor time a millisecond simulated] of the engine's step without contacts";
  table.error_name = "median_difference";
  table.error_axis = "RMS difference of the handle's motion from slaved nodes, implicit [1]: median over stable cases";
  table.more = {"step_s", "unstable_share", "step_ms"};
  for (const Coupled way : kCoupledWays) out.ms.push_back(coupling_ms(way, grid.costed, grid.rounds));
  return out;
}

// All cases of a step's length. False: interrupted.
bool put_step(const CoupledBar& bar, const CouplingGrid& grid, std::size_t t, const Interrupt& interrupt,
              Progress& progress, CouplingTable& out) {
  const double step = grid.steps[t];
  const std::string label = fmt::format("{:.3g} ms", 1e3 * step);
  std::vector<HeatMap> maps;
  std::vector<std::vector<double>> errors(kCoupledWays.size());
  for (const Coupled way : kCoupledWays) maps.push_back({label, name_of(way), {}});
  for (std::size_t h = 0; h < grid.heaviness.size(); ++h) {
    if (interrupt.requested()) return false;
    const auto rows = static_cast<double>(grid.heaviness.size());
    progress.update((static_cast<double>(t) + static_cast<double>(h) / rows) / static_cast<double>(grid.steps.size()));
    CouplingCase c{step, 0.0, grid.heaviness[h]};
    const std::vector<double> truth = bar.swing(Coupled::kSlaved, c, grid.count),
                              turns = bar.swing(Coupled::kStaggeredSlaved, c, grid.count);
    const double swings = rms(truth, std::vector<double>(truth.size(), 0.0));
    for (const double tie : grid.ties)
      for (std::size_t w = 0; w < kCoupledWays.size(); ++w) {
        c.tie = tie;
        const bool sprung = kCoupledWays[w] == Coupled::kSprings || kCoupledWays[w] == Coupled::kStaggeredSprings;
        const std::vector<double> found = sprung ? bar.swing(kCoupledWays[w], c, grid.count) : w == 0 ? truth : turns;
        const double error = found.empty() ? std::numeric_limits<double>::infinity() : rms(found, truth) / swings;
        maps[w].values.push_back(error);
        errors[w].push_back(error);
        out.csv += name_of(kCoupledWays[w]);
        for (const double value : {step, tie, c.heaviness}) put(out.csv, value);
        out.csv += found.empty() ? ",unstable\n" : fmt::format(",{:.6g}\n", error);
      }
  }
  out.maps.maps.insert(out.maps.maps.end(), maps.begin(), maps.end());
  for (std::size_t w = 0; w < kCoupledWays.size(); ++w) {
    std::sort(errors[w].begin(), errors[w].end());
    const auto stable = static_cast<std::size_t>(
        std::count_if(errors[w].begin(), errors[w].end(), [](double e) { return std::isfinite(e); }));
    ParetoRow row;
    row.group = name_of(kCoupledWays[w]);
    row.label = label;
    row.cost = out.ms[w] / step;
    row.error = errors[w][stable / 2];
    row.floor = kResolved;
    row.more = {step, 1.0 - static_cast<double>(stable) / static_cast<double>(errors[w].size()), out.ms[w]};
    out.table.rows.push_back(std::move(row));
  }
  return true;
}

}  // namespace

const char* name_of(Coupled way) {
  constexpr const char* kNames[] = {"implicit slaved", "implicit springs", "staggered slaved", "staggered springs"};
  return kNames[static_cast<std::size_t>(way)];
}

CoupledBar::CoupledBar(int cells) {
  TetMesh mesh = coupled_mesh(cells);
  tets::hold(
      mesh, [](dvec3) { return false; }, in_handle);
  free_ = 3 * static_cast<Eigen::Index>(mesh.free_count), held_ = 3 * static_cast<Eigen::Index>(mesh.handle_count);
  const SoftBody body = tissue_of_bar();
  TissueMaterial material;
  material.young = body.young, material.poisson = body.poisson, material.density = body.density;
  Tissue tissue(mesh, material, mesh.node_count());
  tissue.assemble(1.0, dvec3(0));
  mass_.resize(free_ + held_), push_.resize(free_), ride_.resize(held_, 6);
  dvec3 middle(0);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    mass_.segment<3>(row).setConstant(tissue.mass()[i]);
    if (row >= free_) middle += mesh.nodes[i] / static_cast<double>(mesh.handle_count);
    const double along = mesh.nodes[i].x / (3.0 * kCouplingWide);
    if (row < free_) push_.segment<3>(row) << 0.0, kCouplingPush * along * along, 0.0;
  }
  stiffness_ = tissue.inner().dense() - diagonal(mass_);
  for (Eigen::Index row = 0; row < held_; row += 3)
    ride_.middleRows<3>(row) = grip_matrix(mesh.nodes[static_cast<std::size_t>((free_ + row) / 3)] - middle);
}

std::vector<double> CoupledBar::swing(Coupled way, const CouplingCase& c, int steps) const {
  const bool springs = way == Coupled::kSprings || way == Coupled::kStaggeredSprings;
  const bool staggered = way == Coupled::kStaggeredSlaved || way == Coupled::kStaggeredSprings;
  const Eigen::VectorXd held = mass_.tail(held_);
  const Eigen::MatrixXd plain = ride_.transpose() * held.asDiagonal() * ride_;
  const Eigen::MatrixXd handle = c.heaviness * mass_.head(free_).sum() / held.sum() * plain;
  const Eigen::Index nodes = springs ? free_ + held_ : free_, n = nodes + 6;
  Whole of{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  of.mass.topLeftCorner(free_, free_).diagonal() = mass_.head(free_);  // of the handle's nodes: the handle's
  of.mass.bottomRightCorner(6, 6) = handle;
  if (springs) {
    of.stiffness.topLeftCorner(nodes, nodes) = stiffness_;
  } else {
    of.stiffness.topLeftCorner(free_, free_) = stiffness_.topLeftCorner(free_, free_);
    of.stiffness.topRightCorner(free_, 6) = stiffness_.topRightCorner(free_, held_) * ride_;
    of.stiffness.bottomLeftCorner(6, free_) = of.stiffness.topRightCorner(free_, 6).transpose();
    of.stiffness.bottomRightCorner(6, 6) = ride_.transpose() * stiffness_.bottomRightCorner(held_, held_) * ride_;
  }
  of.damping = kCouplingBeta * of.stiffness;
  if (springs) {
    Eigen::VectorXd k(held_), b(held_);
    for (Eigen::Index i = 0; i < held_; ++i) {
      k[i] = c.tie * kCouplingYoung * std::cbrt(held[i] / tissue_of_bar().density);
      b[i] = 2.0 * std::sqrt(k[i] * held[i]);
    }
    for (const auto& [matrix, by] : {std::pair(&of.stiffness, &k), std::pair(&of.damping, &b)}) {
      const Eigen::MatrixXd to_handle = by->asDiagonal() * ride_;
      matrix->block(free_, free_, held_, held_).diagonal() += *by;
      matrix->block(free_, nodes, held_, 6) -= to_handle;
      matrix->block(nodes, free_, 6, held_) -= to_handle.transpose();
      matrix->bottomRightCorner(6, 6) += ride_.transpose() * to_handle;
    }
  }
  add_hand(of);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(n);
  v.head(free_) = push_;
  return steps_of(of, staggered, std::move(v), c.step, steps);
}

Status study_coupling(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const CouplingGrid grid = grid_of(size);
  const CoupledBar bar(grid.cells);
  CouplingTable all = empty_table(grid);
  Progress progress("study coupling");
  for (std::size_t t = 0; t < grid.steps.size(); ++t)
    if (!put_step(bar, grid, t, interrupt, progress, all)) return interrupted();
  all.table.sentences = {
      sentence_of_stability(all.table.rows),
      fmt::format("A step of {} tetrahedra takes {} ms with slaved nodes and {} ms with springs in one implicit "
                  "system, and {} and {} ms where tissue and handle take turns.",
                  coupled_mesh(grid.costed).tets.size(), two_digits(all.ms[0]), two_digits(all.ms[1]),
                  two_digits(all.ms[2]), two_digits(all.ms[3]))};
  if (const Status done = write_text(out, "coupling_grid.csv", all.csv); !done) return done;
  if (const Status done = plot_heat_maps(out, "coupling_stability", all.maps); !done) return done;
  return write_study(out, all.table);
}

}  // namespace pliant
