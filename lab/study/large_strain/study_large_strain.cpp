// A cube between two bonded plates, squashed, pulled and sheared: the force of tissue by law and resolution, against
// quadratic tetrahedra of a Neo-Hookean or exponential law (scenes/quadratic_block.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "lab/console/progress.h"
#include "lab/study/pareto.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "scenes/quadratic_block.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kCubeSide = 0.1, kCubeYoung = 1e4, kCubePoisson = 0.4, kCubeStiffening = 0.2;  // [m], [Pa], [1], [1]

struct PlateLoad {
  const char* name;
  dvec3 way;  // [m] of the far plate
  int axis;   // of the force
};
const PlateLoad kPlateLoads[] = {{"squash 25 %", {-0.025, 0, 0}, 0},
                                 {"squash 50 %", {-0.05, 0, 0}, 0},
                                 {"pull 50 %", {0.05, 0, 0}, 0},
                                 {"shear 100 %", {0, 0.1, 0}, 1}};
constexpr std::size_t kLoadCount = std::size(kPlateLoads);

struct StudiedLaw {
  TissueLaw law;
  const char* name;
  TissueLaw of_twin;
};
constexpr StudiedLaw kStudiedLaws[] = {
    {TissueLaw::kCorotational, "corotational, against neo_hookean", TissueLaw::kNeoHookean},
    {TissueLaw::kNeoHookean, "neo_hookean", TissueLaw::kNeoHookean},
    {TissueLaw::kFung, "fung", TissueLaw::kFung}};

struct LargeStrainPlan {
  std::vector<int> cells;  // per side, of linear tetrahedra
  int twin, coarser;       // of quadratic ones; of those that show whether these have converged
};
LargeStrainPlan large_strain_plan(StudySize size) {
  if (size == StudySize::kSmall) return {{1, 2}, 2, 1};
  if (size == StudySize::kQuick) return {{2, 4, 6}, 3, 2};
  return {{2, 3, 4, 6, 8, 12}, 6, 4};
}

using Forces = std::array<double, kLoadCount>;  // [N]

// NaN where it does not settle. `ms`: CPU time of a load, on average.
Forces tissue_forces(TissueLaw law, int cells, double& ms) {
  TetMesh mesh = tets::box(cells, cells, cells, dvec3(0), dvec3(kCubeSide));
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9 || p.x > kCubeSide - 1e-9; });
  Forces out{};
  const std::uint64_t begin = process_ns();
  for (std::size_t l = 0; l < kLoadCount; ++l) {
    Tissue tissue(
        mesh,
        {.young = kCubeYoung, .poisson = kCubePoisson, .density = 1000, .law = law, .stiffening = kCubeStiffening},
        mesh.free_count);
    auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
    solver->analyse(tissue.inner());
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      tissue.position()[i] += mesh.nodes[i].x / kCubeSide * kPlateLoads[l].way;
    const bool settled = settle_tissue(tissue, *solver, dvec3(0), {.iterations = 100, .tolerance = 1e-8}).solved;
    tissue.find_forces();
    for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i)
      if (mesh.nodes[i].x > kCubeSide - 1e-9) out[l] -= tissue.elastic_force()[3 * i + kPlateLoads[l].axis];
    if (!settled) out[l] = std::numeric_limits<double>::quiet_NaN();
  }
  ms = static_cast<double>(process_ns() - begin) * 1e-6 / kLoadCount;
  return out;
}

Forces twin_forces(TissueLaw law, int cells) {
  const LawConstants material{kCubeYoung / (2 * (1 + kCubePoisson)),
                              kCubeYoung * kCubePoisson / ((1 + kCubePoisson) * (1 - 2 * kCubePoisson)),
                              kCubeStiffening};
  QuadraticBlock twin(cells, kCubeSide, elastic_law(law), material);
  Forces out{};
  for (std::size_t l = 0; l < kLoadCount; ++l) {
    const std::optional<dvec3> force = twin.press(kPlateLoads[l].way);
    out[l] = force ? (*force)[kPlateLoads[l].axis] : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

// [1] The largest; NaN counts as infinite.
double largest_off(const Forces& off) {
  double most = 0.0;
  for (const double each : off) most = std::max(most, std::isnan(each) ? HUGE_VAL : std::abs(each));
  return most;
}
Forces off_from(const Forces& force, const Forces& truth) {
  Forces off{};
  for (std::size_t l = 0; l < kLoadCount; ++l) off[l] = force[l] / truth[l] - 1.0;
  return off;
}

}  // namespace

Status study_large_strain(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Progress progress("study large_strain");
  const LargeStrainPlan plan = large_strain_plan(size);
  ParetoTable table;
  table.study = "large_strain";
  table.title = "force of a bonded cube of linear tetrahedra, squashed, pulled and sheared, against quadratic ones";
  table.cost_name = "cost_ms", table.cost_axis = "CPU time of an equilibrium [ms]";
  table.error_name = "error", table.error_axis = "largest error of the force [1]";
  table.more = {"tetrahedra"};
  for (const PlateLoad& load : kPlateLoads) table.more.emplace_back(load.name);
  table.front_by_group = true;
  double of_twin = 0.0;
  std::string finest;
  for (std::size_t i = 0; i < std::size(kStudiedLaws); ++i) {
    const StudiedLaw& studied = kStudiedLaws[i];
    const Forces truth = twin_forces(studied.of_twin, plan.twin);
    if (i > 0) of_twin = std::max(of_twin, largest_off(off_from(twin_forces(studied.of_twin, plan.coarser), truth)));
    for (const int cells : plan.cells) {
      if (interrupt.requested()) return interrupted();
      ParetoRow row;
      const Forces off = off_from(tissue_forces(studied.law, cells, row.cost), truth);
      row.label = fmt::format("{} cells", cells), row.group = studied.name, row.error = largest_off(off);
      row.more = {static_cast<std::int64_t>(tets::box(cells, cells, cells, dvec3(0), dvec3(1)).tets.size())};
      row.more.insert(row.more.end(), off.begin(), off.end());
      table.rows.push_back(row);
    }
    finest += fmt::format("{}{} by {} %", i > 0 ? ", " : "", studied.name, two_digits(100.0 * table.rows.back().error));
    progress.update(static_cast<double>(i + 1) / static_cast<double>(std::size(kStudiedLaws)));
  }
  table.sentences = {
      fmt::format("With {} cells a side the largest of four forces is off: {}.", plan.cells.back(), finest),
      fmt::format("The reference, quadratic tetrahedra in {} cells a side, differs from one of {} by {} % at most.",
                  plan.twin, plan.coarser, two_digits(100.0 * of_twin))};
  return write_study(out, table);
}

}  // namespace pliant
