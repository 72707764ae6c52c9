#include "systems/soft/local/smearing_surface.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "systems/soft/fem/polar.h"

namespace pliant {
namespace {

constexpr double kCut = 3.0;           // [1] standard deviations
constexpr double kFacingAlike = 0.5;   // [1] cosine between the normals of a contact and of what it is smeared over
constexpr double kEvenLattice = 1.01;  // [1] coarsest over finest cell: an even lattice
constexpr double kBehind = 1.0;        // [1] of a cell: nodes this close to the contact's axis are behind it
constexpr double kLayer = 4.0;         // [1] of R: thicker tissue is a half-space
constexpr double kThinLayer = 0.5;     // [1] of R: thinner ones as this

double longest_edge_of(const TetMesh& tets, const Tet& tet) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, length(tets.nodes[tet[i]] - tets.nodes[tet[k]]));
  return longest;
}

// [m] Per node, of a lattice of uneven cells: the mean longest edge of the elements around it.
std::vector<double> cells_of(const TetMesh& tets) {
  std::vector<double> sum(tets.nodes.size(), 0.0), count(tets.nodes.size(), 0.0);
  for (const Tet& tet : tets.tets) {
    const double edge = longest_edge_of(tets, tet);
    for (const std::uint32_t node : tet) sum[node] += edge, count[node] += 1.0;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(1.0, count[i]);
  return sum;
}

template <class Of>
auto embedded(const TetMesh& tets, const Embedding& place, Of of) {
  const Tet& tet = tets.tets[place.tet];
  auto out = place.weight[0] * of(tet[0]);
  for (std::size_t k = 1; k < 4; ++k) out += place.weight[k] * of(tet[k]);
  return out;
}

// Moves the sums, over their total, into parts; in the order in which they were added.
void take(std::vector<double>& sums, double total, std::vector<std::pair<std::uint32_t, double>>& parts) {
  std::size_t kept = 0;
  for (const auto& part : parts) {
    double& sum = sums[part.first];
    if (sum == 0.0) continue;
    parts[kept++] = {part.first, sum / total};
    sum = 0.0;
  }
  parts.resize(kept);
}

}  // namespace

SmearingSurface::SmearingSurface(const TetMesh& tets, double poisson)
    : tets_(tets), poisson_(poisson), layer_(poisson) {
  ASSERT(!tets.samples.empty());
  // A body that keeps its shape under gravity is embedded in its first shape, not in that without weight.
  rest_ = &tets.nodes;
  if (!tets.start.empty()) {
    double of_nodes = 0.0, of_start = 0.0;  // [m] how far the samples are from where they were taken
    for (const SurfaceSample& sample : tets.samples) {
      const auto off = [&](const std::vector<dvec3>& x) {
        return length(embedded(tets, sample.embedding, [&](std::uint32_t node) { return x[node]; }) - sample.position);
      };
      of_nodes += off(tets.nodes), of_start += off(tets.start);
    }
    if (of_start < of_nodes) rest_ = &tets.start;
  }
  of_nodes_.assign(tets.nodes.size(), 0.0);
  of_tets_.assign(tets.tets.size(), 0.0);
  const bool even = tets.report.cell > 0.0 && tets.report.coarsest < kEvenLattice * tets.report.cell;
  const std::vector<double> cells = even ? std::vector<double>() : cells_of(tets);
  dvec3 high(-1e300);
  low_ = dvec3(1e300);
  for (const SurfaceSample& sample : tets.samples) {
    position_.push_back(embedded(tets, sample.embedding, [&](std::uint32_t node) { return (*rest_)[node]; }));
    cell_.push_back(even ? tets.report.cell
                         : embedded(tets, sample.embedding, [&](std::uint32_t node) { return cells[node]; }));
    low_ = glm::min(low_, position_.back()), high = glm::max(high, position_.back());
    widest_ = std::max(widest_, cell_.back());
  }
  widest_ *= smearing_cells(poisson) * kCut * kSigmaOfRadius;
  for (int k = 0; k < 2; ++k) across_[k] = static_cast<std::int64_t>((high[k] - low_[k]) / widest_) + 3;
  for (std::uint32_t i = 0; i < position_.size(); ++i) boxes_[box_of(position_[i])].push_back(i);
}

std::int64_t SmearingSurface::box_of(dvec3 at) const {
  const dvec3 place = glm::floor((at - low_) / widest_) + 1.0;
  return (static_cast<std::int64_t>(place.z) * across_[1] + static_cast<std::int64_t>(place.y)) * across_[0] +
         static_cast<std::int64_t>(place.x);
}

template <class Use>
void SmearingSurface::for_samples_near(dvec3 at, double reach, Use use) const {
  const dvec3 middle = glm::floor((at - low_) / widest_) + 1.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const dvec3 box = middle + dvec3(x, y, z);
        if (box.x < 0 || box.y < 0 || box.x >= static_cast<double>(across_[0]) ||
            box.y >= static_cast<double>(across_[1]))
          continue;
        const auto found = boxes_.find(
            (static_cast<std::int64_t>(box.z) * across_[1] + static_cast<std::int64_t>(box.y)) * across_[0] +
            static_cast<std::int64_t>(box.x));
        if (found == boxes_.end()) continue;
        for (const std::uint32_t i : found->second) {
          const dvec3 apart = position_[i] - at;
          const double square = dot(apart, apart);
          if (square < reach * reach) use(i, square);
        }
      }
}

// The cell of the nearest sample decides, so that R is the same for the whole of an even lattice.
double SmearingSurface::radius_at(dvec3 at) const {
  double nearest = 1e300, cell = 0.0;
  for_samples_near(at, widest_, [&](std::uint32_t i, double square) {
    if (square < nearest) nearest = square, cell = cell_[i];
  });
  return smearing_cells(poisson_) * (cell > 0.0 ? cell : cell_.front());
}

double SmearingSurface::thickness_at(dvec3 at, dvec3 normal, double radius) const {
  const double aside = kBehind * radius / smearing_cells(poisson_);
  double thickness = kLayer * radius;
  for (std::size_t i = tets_.free_count; i < tets_.nodes.size(); ++i) {
    const dvec3 apart = at - (*rest_)[i];
    const double deep = dot(apart, normal);
    if (deep > 0.0 && deep < thickness && dot(apart, apart) - deep * deep < aside * aside) thickness = deep;
  }
  return thickness < kLayer * radius ? std::max(thickness, kThinLayer * radius) : 0.0;
}

SmearedLoad SmearingSurface::load_at(dvec3 at, dvec3 normal, double own) const {
  SmearedLoad out;
  const double radius = radius_at(at), sigma = kSigmaOfRadius * radius;
  out.place = {at,
               normal,
               own,
               radius,
               tets_.cells.empty() ? lattice_compliance(poisson_, smearing_cells(poisson_)) : kComplianceOfCells,
               thickness_at(at, normal, radius)};
  out.pair_radius = own;
  double sum = 0.0;
  for_samples_near(at, kCut * sigma, [&](std::uint32_t i, double square) {
    const SurfaceSample& sample = tets_.samples[i];
    if (!(dot(sample.normal, normal) > kFacingAlike)) return;
    const double weight = sample.area * std::exp(-square / (2 * sigma * sigma));
    const auto add = [](std::vector<double>& sums, std::uint32_t i_of, double part, auto& parts) {
      if (sums[i_of] == 0.0) parts.emplace_back(i_of, 0.0);
      sums[i_of] += part;
    };
    add(of_tets_, sample.embedding.tet, weight, out.tets);
    for (std::size_t k = 0; k < 4; ++k)
      if (sample.embedding.weight[k] != 0.0)
        add(of_nodes_, tets_.tets[sample.embedding.tet][k], weight * sample.embedding.weight[k], out.nodes);
    sum += weight;
  });
  take(of_nodes_, sum, out.nodes);
  take(of_tets_, sum, out.tets);
  for (const auto& part : out.nodes) out.mean += part.second * (*rest_)[part.first];
  return out;
}

void SmearingSurface::follow(const std::vector<dvec3>& nodes, SmearedLoad& load) const {
  load.moved = dvec3(0.0);
  for (const auto& part : load.nodes) load.moved += part.second * nodes[part.first];
  dmat3 gradient(0.0);
  for (const auto& part : load.tets) {
    const Tet& t = tets_.tets[part.first];
    const auto edges = [&](const std::vector<dvec3>& x) {
      return dmat3(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]]);
    };
    gradient += part.second * (edges(nodes) * glm::inverse(edges(*rest_)));
  }
  dquat q = glm::quat_cast(load.turn);
  extract_rotation(gradient, q);
  load.turn = glm::mat3_cast(q);
}

}  // namespace pliant
