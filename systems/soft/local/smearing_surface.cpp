#include "systems/soft/local/smearing_surface.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "systems/soft/collide/farthest_axis.h"
#include "systems/soft/fem/polar.h"

namespace pliant {
namespace {

constexpr double kCut = 3.0;           // [1] standard deviations
constexpr double kFacingAlike = 0.5;   // [1] cosine between the normals of a contact and of what it is smeared over
constexpr double kEvenLattice = 1.01;  // [1] coarsest over finest cell: an even lattice
constexpr double kBehind = 1.0;        // [1] of a cell: nodes this close to the contact's axis are behind it
constexpr double kAnchorsApart = 0.7;  // [1] of R
constexpr double kFacesAnchor = 0.8;   // [1] cosine: an anchor stands for what faces like it
constexpr double kAnchorReach = 1.5;   // [1] of R: anchors of a contact,
constexpr double kFadesOut = 0.05;     // [1] whose shares fade there
constexpr double kConditions = 1e3;    // [1] weight of the conditions on the shares
constexpr std::uint32_t kNoPlace = 0xffffffffu;
constexpr double kLayer = 4.0;      // [1] of R: thicker tissue is a half-space
constexpr double kThinLayer = 0.5;  // [1] of R: thinner ones as this

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
  sum_place_.assign(tets.nodes.size(), kNoPlace);
  const bool even = tets.report.cell > 0.0 && tets.report.coarsest < kEvenLattice * tets.report.cell;
  if (even) even_ = tets.report.cell;
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
  choose_anchors();
}

void SmearingSurface::choose_anchors() {
  for (std::uint32_t i = 0; i < position_.size(); ++i) {
    const double radius = smearing_cells(poisson_) * cell_[i];
    bool taken = false;
    for_boxes_near(position_[i], anchor_boxes_, [&](std::uint32_t a) {
      const dvec3 apart = anchors_[a].at - position_[i];
      const double least = kAnchorsApart * radius;
      taken = taken ||
              (dot(apart, apart) < least * least && dot(anchors_[a].normal, tets_.samples[i].normal) > kFacesAnchor);
    });
    if (taken) continue;
    anchor_boxes_[box_of(position_[i])].push_back(static_cast<std::uint32_t>(anchors_.size()));
    anchors_.push_back({position_[i], tets_.samples[i].normal, radius, {}, dvec3(0)});
  }
}

const SmearingSurface::Anchor& SmearingSurface::loaded_anchor(std::uint32_t anchor) const {
  Anchor& out = anchors_[anchor];
  if (out.nodes.empty()) {
    SmearedLoad load = load_alone(out.at, out.normal, 1.0);
    out.nodes = std::move(load.nodes);
    out.mean = load.mean;
    out.thickness = load.place.thickness;
  }
  return out;
}

void SmearingSurface::collect(std::span<const SmearedNode> nodes, double factor, std::vector<SmearedNode>& sum) const {
  for (const SmearedNode& part : nodes) {
    std::uint32_t& place = sum_place_[part.node];
    if (place == kNoPlace) place = static_cast<std::uint32_t>(sum.size()), sum.push_back({part.node, 0.0, dvec3(0.0)});
    sum[place].weight += factor * part.weight;
    sum[place].gradient += factor * part.gradient;
  }
}

void SmearingSurface::finish(double total, std::vector<SmearedNode>& sum) const {
  for (SmearedNode& part : sum) {
    sum_place_[part.node] = kNoPlace;
    part.weight /= total, part.gradient /= total;
  }
}

std::int64_t SmearingSurface::box_of(dvec3 at) const {
  const dvec3 place = glm::floor((at - low_) / widest_) + 1.0;
  return (static_cast<std::int64_t>(place.z) * across_[1] + static_cast<std::int64_t>(place.y)) * across_[0] +
         static_cast<std::int64_t>(place.x);
}

template <class Use>
void SmearingSurface::for_boxes_near(dvec3 at,
                                     const std::unordered_map<std::int64_t, std::vector<std::uint32_t>>& boxes,
                                     Use use) const {
  const dvec3 middle = glm::floor((at - low_) / widest_) + 1.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const dvec3 box = middle + dvec3(x, y, z);
        if (box.x < 0 || box.y < 0 || box.x >= static_cast<double>(across_[0]) ||
            box.y >= static_cast<double>(across_[1]))
          continue;
        const auto found =
            boxes.find((static_cast<std::int64_t>(box.z) * across_[1] + static_cast<std::int64_t>(box.y)) * across_[0] +
                       static_cast<std::int64_t>(box.x));
        if (found == boxes.end()) continue;
        for (const std::uint32_t i : found->second) use(i);
      }
}

template <class Use>
void SmearingSurface::for_samples_near(dvec3 at, double reach, Use use) const {
  for_boxes_near(at, boxes_, [&](std::uint32_t i) {
    const dvec3 apart = position_[i] - at;
    const double square = dot(apart, apart);
    if (square < reach * reach) use(i, square);
  });
}

// The cell of the nearest sample decides, so that R is the same for the whole of an even lattice.
double SmearingSurface::radius_at(dvec3 at) const {
  if (even_ > 0.0) return smearing_cells(poisson_) * even_;
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

LocalPlace SmearingSurface::place_at(dvec3 at, dvec3 normal, double own) const {
  const double radius = radius_at(at);
  const LatticeCompliance lattice =
      tets_.cells.empty() ? lattice_compliance(poisson_, smearing_cells(poisson_)) : kComplianceOfCells;
  return {at, normal, own, radius, lattice, 0.0};
}

SmearedLoad SmearingSurface::load_alone(dvec3 at, dvec3 normal, double own) const {
  SmearedLoad out;
  out.place = place_at(at, normal, own);
  out.place.thickness = thickness_at(at, normal, out.place.smeared);
  out.pair_radius = own;
  const double sigma = kSigmaOfRadius * out.place.smeared;
  double sum = 0.0;
  for_samples_near(at, kCut * sigma, [&](std::uint32_t i, double square) {
    const SurfaceSample& sample = tets_.samples[i];
    if (!(dot(sample.normal, normal) > kFacingAlike)) return;
    const double weight = sample.area * std::exp(-square / (2 * sigma * sigma));
    const Tet& t = tets_.tets[sample.embedding.tet];
    const std::vector<dvec3>& x = *rest_;
    // Rows of the inverse: gradients of the shape functions of the last three corners.
    const dmat3 inverse = glm::transpose(glm::inverse(dmat3(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]])));
    SmearedNode parts[4];
    for (int k = 0; k < 4; ++k) {
      const dvec3 gradient = k > 0 ? inverse[k - 1] : -(inverse[0] + inverse[1] + inverse[2]);
      parts[k] = {t[static_cast<std::size_t>(k)], sample.embedding.weight[static_cast<std::size_t>(k)], gradient};
    }
    collect(parts, weight, out.nodes);
    sum += weight;
  });
  finish(sum, out.nodes);
  for (const SmearedNode& part : out.nodes) out.mean += part.weight * (*rest_)[part.node];
  return out;
}

SmearedLoad SmearingSurface::load_at(dvec3 at, dvec3 normal, double own) const {
  SmearedLoad out;
  out.place = place_at(at, normal, own);
  out.pair_radius = own;
  const double radius = out.place.smeared, reach = kAnchorReach * radius;
  for_boxes_near(at, anchor_boxes_, [&](std::uint32_t a) {
    const dvec3 apart = anchors_[a].at - at;
    if (dot(apart, apart) < reach * reach && dot(anchors_[a].normal, normal) > kFacingAlike)
      out.anchors.emplace_back(a, 0.0);
  });
  if (out.anchors.empty()) return load_alone(at, normal, own);
  const auto count = static_cast<Eigen::Index>(out.anchors.size());
  const double sigma = kSigmaOfRadius * radius / out.place.lattice.normal, most = h0(0.0, sigma);
  const auto anchor = [&](Eigen::Index a) -> const Anchor& {
    return anchors_[out.anchors[static_cast<std::size_t>(a)].first];
  };
  Eigen::MatrixXd K(count, count), P(count, 3);
  Vector right(count);
  const dvec3 x = normalize(cross(normal, farthest_axis(normal))), y = cross(normal, x);
  for (Eigen::Index a = 0; a < count; ++a) {
    const Anchor& one = loaded_anchor(out.anchors[static_cast<std::size_t>(a)].first);
    const dvec3 apart = one.at - at;
    const double share = dot(apart, apart) / (reach * reach);
    for (Eigen::Index b = 0; b <= a; ++b)
      K(a, b) = K(b, a) = h0(length(one.at - anchor(b).at), sigma) * dot(one.normal, anchor(b).normal);
    K(a, a) += most * kFadesOut * std::pow(share, 4) / std::max(1.0 - share, 1e-9);
    right[a] = h0(std::sqrt(dot(apart, apart)), sigma) * dot(one.normal, normal);
    P.row(a) << 1.0, dot(apart, x) / radius, dot(apart, y) / radius;
  }
  K.noalias() += kConditions * most * P * P.transpose();
  right += kConditions * most * P.col(0);
  const Vector phi = K.ldlt().solve(right);
  const double total = phi.sum();
  double thin = 0.0;  // [1/m]
  for (Eigen::Index a = 0; a < count; ++a) {
    auto& part = out.anchors[static_cast<std::size_t>(a)];
    part.second = phi[a] / total;
    const Anchor& one = anchor(a);
    collect(one.nodes, part.second, out.nodes);
    out.mean += part.second * one.mean;
    if (one.thickness > 0.0) thin += part.second / one.thickness;
  }
  if (thin > 1.0 / (kLayer * radius)) out.place.thickness = 1.0 / std::min(thin, 1.0 / (kThinLayer * radius));
  finish(1.0, out.nodes);
  return out;
}

Eigen::MatrixXd SmearingSurface::missing(std::span<const SmearedLoad* const> loads) const {
  const auto count = static_cast<Eigen::Index>(loads.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, count);
  std::vector<std::uint32_t> anchors;
  for (const SmearedLoad* load : loads)
    for (const auto& part : load->anchors) anchors.push_back(part.first);
  std::sort(anchors.begin(), anchors.end());
  anchors.erase(std::unique(anchors.begin(), anchors.end()), anchors.end());
  if (anchors.empty()) return out;
  const LocalPlace& first = loads.front()->place;
  const double sigma = kSigmaOfRadius * first.smeared / first.lattice.normal;
  const auto size = static_cast<Eigen::Index>(anchors.size());
  Eigen::MatrixXd K(size, size), phi = Eigen::MatrixXd::Zero(count, size);
  for (Eigen::Index a = 0; a < size; ++a)
    for (Eigen::Index b = 0; b <= a; ++b) {
      const Anchor &one = anchors_[anchors[static_cast<std::size_t>(a)]],
                   &other = anchors_[anchors[static_cast<std::size_t>(b)]];
      K(a, b) = K(b, a) = h0(length(one.at - other.at), sigma) * dot(one.normal, other.normal);
    }
  for (Eigen::Index i = 0; i < count; ++i)
    for (const auto& part : loads[static_cast<std::size_t>(i)]->anchors)
      phi(i, std::lower_bound(anchors.begin(), anchors.end(), part.first) - anchors.begin()) = part.second;
  const Eigen::MatrixXd half = phi * K;
  out.noalias() = half * phi.transpose();
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const SmearedLoad &one = *loads[static_cast<std::size_t>(i)], &other = *loads[static_cast<std::size_t>(j)];
      if (one.anchors.empty() || other.anchors.empty())
        out(i, j) = 0.0;
      else
        out(i, j) =
            h0(length(one.place.at - other.place.at), sigma) * dot(one.place.normal, other.place.normal) - out(i, j);
    }
  return out;
}

void SmearingSurface::follow(const std::vector<dvec3>& nodes, SmearedLoad& load) const {
  load.moved = dvec3(0.0);
  dmat3 gradient(0.0);
  for (const SmearedNode& part : load.nodes) {
    const dvec3 x = nodes[part.node];
    load.moved += part.weight * x;
    for (int k = 0; k < 3; ++k) gradient[k] += part.gradient[k] * x;
  }
  dquat q = glm::quat_cast(load.turn);
  extract_rotation(gradient, q);
  load.turn = glm::mat3_cast(q);
}

}  // namespace pliant
