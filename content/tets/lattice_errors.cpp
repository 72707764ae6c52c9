#include "content/tets/lattice_errors.h"

#include <algorithm>
#include <cmath>

#include "content/tets/surface_shape.h"
#include "content/tets/tet_quality.h"

namespace pliant {
namespace {

constexpr double kBendsOfTets = 0.85, kBendsOfCells = 0.2;  // [1] times the cells across, squared
constexpr double kTwistsOfTets = 2.1, kTwistsOfCells = 0.3;
constexpr double kContactOfTets = 1.06, kContactFalls = 1.1;   // [1] at a = c, and the power of c / a
constexpr double kUsualPoisson = 0.3, kLockingGrowth = 0.008;  // [1] a share of lambda / mu

}  // namespace

LatticeErrors expected_errors(const TetMesh& mesh, const Mesh& surface, double poisson) {
  LatticeErrors out;
  if (!(mesh.report.cell > 0.0)) return out;
  std::vector<double> thickness;
  for (const ThicknessSample& sample : measure_shape(surface).samples)
    if (sample.thickness > 0.0) thickness.push_back(sample.thickness);
  if (thickness.empty()) return out;
  const auto middle = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
  std::nth_element(thickness.begin(), middle, thickness.end());
  out.across = *middle / mesh.report.cell;
  const bool cells = !mesh.cells.empty();
  const double tissue = tissue_volume(mesh);
  if (!cells && tissue > 0.0) out.section = total_volume(mesh) / tissue - 1.0;
  const auto stiffer = [](double nu) { return 2 * nu / (1 - 2 * nu); };  // lambda / mu
  const double locking = cells ? 1.0 : 1.0 + kLockingGrowth * std::max(0.0, stiffer(poisson) - stiffer(kUsualPoisson));
  // The missing part lies at the edges of a section.
  const double square = out.across * out.across, section = 1.0 + 2.0 * out.section;
  out.bending = section * (1.0 + (cells ? kBendsOfCells : kBendsOfTets) * locking / square) - 1.0;
  out.torsion = section * (1.0 + (cells ? kTwistsOfCells : kTwistsOfTets) * locking / square) - 1.0;
  out.contact_radius = kContactOfThickness * *middle;
  out.contact = kContactOfTets * std::pow(mesh.report.cell / out.contact_radius, kContactFalls);
  return out;
}

}  // namespace pliant
