#include "lab/study/fidelity/fidelity_truth.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace pliant {

Result<std::vector<DepthTruth>> limits_of(const Indented& what, const std::vector<int>& cells,
                                          const std::vector<double>& depths, GridPresses& all,
                                          const Interrupt& interrupt, Progress& progress, double from, double part) {
  std::vector<DepthTruth> out(depths.size());
  // Run time grows with nearly the sixth power of the cells.
  double done = 0.0, whole = 0.0;
  for (const int n : cells) whole += std::pow(n, 6);
  for (const int n : cells) {
    const double own = std::pow(n, 6) / whole;
    auto pressed = press_block(what.block(n), depths, [&](double share) {
      progress.update(from + part * (done + own * share));
      return !interrupt.requested();
    });
    if (!pressed) return pressed.error();
    done += own;
    for (std::size_t d = 0; d < depths.size(); ++d) {
      out[d].force.push_back((*pressed)[d].force);
      out[d].surface.push_back(block_truth("block", what.radius, (*pressed)[d]));
    }
    all.push_back(std::move(*pressed));
  }
  for (std::size_t d = 0; d < depths.size(); ++d) {
    out[d].depth = depths[d];
    out[d].limit = grid_limit(cells, out[d].force);
    out[d].sure = std::numeric_limits<double>::quiet_NaN();
    if (cells.size() > 3)
      out[d].sure =
          std::abs(grid_limit({cells.begin(), cells.end() - 1}, {out[d].force.begin(), out[d].force.end() - 1}).limit /
                       out[d].limit.limit -
                   1);
  }
  return out;
}

std::string truth_csv(const std::vector<int>& cells, const std::vector<DepthTruth>& truths, const GridPresses& all) {
  std::string csv = "depth_m,cells,tetrahedra,force_N,secant_over_small_strain,order,limit_changed_by\n";
  const double small = truths.front().limit.limit / truths.front().depth;
  for (const DepthTruth& truth : truths) {
    for (std::size_t i = 0; i < all.size(); ++i)
      csv += fmt::format("{:.6g},{},{},{:.9g},{:.6g},,\n", truth.depth, cells[i], all[i].front().tets, truth.force[i],
                         truth.force[i] / truth.depth * truths.front().depth / truths.front().force[i]);
    csv += fmt::format("{:.6g},limit,,{:.9g},{:.6g}", truth.depth, truth.limit.limit,
                       truth.limit.limit / truth.depth / small);
    for (const double value : {truth.limit.order, truth.sure})
      csv += std::isfinite(value) ? fmt::format(",{:.3g}", value) : ",";
    csv += '\n';
  }
  return csv;
}

}  // namespace pliant
