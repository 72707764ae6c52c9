#include "lab/fit/surface_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "lab/fit/least_squares.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/model/local_model.h"
#include "systems/touch/model/shape.h"

namespace pliant {
namespace {

constexpr double kLeastFitContact = 0.1, kMostContact = 0.9, kContactStep = 0.05;  // [1] of the reach
constexpr double kLeastFittedReach = 1.5;                                          // [1] in radii of the indenter
constexpr int kReaches = 20;          // tried from the least reach to the usual one, and from that to the widest
constexpr double kGoodShape = 0.10;   // [1] of the depth: below this error no wider reach is tried
constexpr std::size_t kNearest = 10;  // painted places from which a vertex is interpolated

// `contact` [1]: contact radius as a share of the reach.
FieldSource source_of(const PressPlace& place, Shape shape, double reach, double volume, double contact) {
  FieldSource source;
  source.center = vec3(place.position);
  source.normal = vec3(place.normal);
  source.amplitude = 1.0f;
  source.inv_reach2 = static_cast<float>(1 / (reach * reach));
  source.shape = shape;
  source.parameter = shape_parameter(shape, contact * reach, reach, volume);
  return source;
}

std::uint64_t next_random(std::uint64_t& state) {  // splitmix64 (Steele, Lea & Flood 2014)
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
double next_share(std::uint64_t& state) {
  return static_cast<double>(next_random(state) >> 11) * 0x1p-53;
}

// Data for comparing shapes, gathered once.
struct Sample {
  vec3 position, normal;
  double area = 0.0;
  double share = 0.0, square = 0.0;  // share of the depth and its square: means over the presses
};

}  // namespace

SurfaceDifference surface_difference(const std::vector<PlacedSample>& seen, const std::vector<double>& heights,
                                     const std::vector<double>& truth) {
  SurfaceDifference out;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double d = heights[i] - truth[i];
    out.off += seen[i].area * d * d;
    out.size += seen[i].area * truth[i] * truth[i];
    out.area += seen[i].area;
  }
  return out;
}

SurfaceDifference radial_remainder(const std::vector<PlacedSample>& seen, const PressPlace& place, double radius,
                                   const std::vector<double>& heights) {
  constexpr Eigen::Index kKnots = 4 * static_cast<Eigen::Index>(kAroundPress) + 1;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kKnots, kKnots);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kKnots);
  SurfaceDifference out;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double at = std::min(4 * length(seen[i].position - place.position) / radius, static_cast<double>(kKnots - 1));
    const Eigen::Index k = std::min(static_cast<Eigen::Index>(at), kKnots - 2);
    const double area = seen[i].area, h = heights[i],
                 share[2] = {1 - (at - static_cast<double>(k)), at - static_cast<double>(k)};
    for (Eigen::Index a = 0; a < 2; ++a) {
      right[k + a] += area * share[a] * h;
      for (Eigen::Index b = 0; b < 2; ++b) normal(k + a, k + b) += area * share[a] * share[b];
    }
    out.size += area * h * h;
    out.area += area;
  }
  normal.diagonal().array() += 1e-12 * out.area;  // keeps a ring without samples solvable
  const Eigen::VectorXd best = normal.ldlt().solve(right);
  out.off = std::max(0.0, out.size - 2 * best.dot(right) + best.dot(normal * best));
  return out;
}

bool is_near_an_edge(const Mesh& mesh, const PressPlace& place, double depth) {
  constexpr double kTurned = 0.5, kWithin = 1.5;  // [1] cosine; [1] depths
  const dvec3 end = place.position - depth * place.normal;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 corner = mesh.triangles[t];
    const dvec3 a(mesh.position(corner.x)), b(mesh.position(corner.y)), c(mesh.position(corner.z));
    const dvec3 twice = cross(b - a, c - a);
    if (dot(twice, place.normal) > kTurned * length(twice)) continue;
    if (closest_on_triangle(mesh, t, end).distance2 < kWithin * kWithin * depth * depth) return true;
  }
  return false;
}

ShapeFit fit_shape(const std::vector<PressedPlace>& places, double radius, double reach) {
  std::vector<const PressedPlace*> pressed;
  std::vector<std::vector<Sample>> samples;
  for (const PressedPlace& each : places) {
    if (each.presses.empty()) continue;
    pressed.push_back(&each);
    std::vector<Sample>& of = samples.emplace_back();
    for (std::size_t i = 0; i < each.seen.size(); ++i) {
      Sample& sample =
          of.emplace_back(Sample{vec3(each.seen[i].position), vec3(each.seen[i].normal), each.seen[i].area});
      for (const PressedTissue& press : each.presses) {
        const double share = -press.height[i] / press.depth;
        sample.share += share / static_cast<double>(each.presses.size());
        sample.square += share * share / static_cast<double>(each.presses.size());
      }
    }
  }
  ShapeFit best;
  best.error = 1e30;
  const auto attempt = [&](Shape shape, double volume, double over, double contact) {
    double sum = 0.0, of_depth = 0.0;
    for (std::size_t at = 0; at < pressed.size(); ++at) {
      const FieldSource source = source_of(pressed[at]->place, shape, over, volume, contact);
      double off = 0.0, size = 0.0, area = 0.0;
      for (const Sample& s : samples[at]) {
        const vec3 away = s.position - source.center;
        const double f = dot(away, away) * source.inv_reach2 < 1.0f
                             ? static_cast<double>(share_at(source, s.position, s.normal))
                             : 0.0;
        off += s.area * (f * f - 2 * f * s.share + s.square);
        size += s.area * s.square;
        area += s.area;
      }
      sum += size > 0 ? off / size : 0.0;
      of_depth += area > 0 ? off / area / static_cast<double>(pressed.size()) : 0.0;
    }
    const double error = pressed.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(pressed.size()));
    if (error < best.error)
      best = {shape, over, volume, depends_on_contact(shape) ? contact * over : 0.0, error, std::sqrt(of_depth)};
  };
  const auto try_between = [&](double least, double most) {
    const auto every_reach = [&](Shape shape, double volume, double contact) {
      if (reach > 0) return attempt(shape, volume, reach, contact);
      for (int i = 0; i <= kReaches; ++i)
        attempt(shape, volume, least * std::pow(most / least, i / (kReaches * 1.0)) * radius, contact);
    };
    const auto every_shape = [&](const auto& wanted, const auto& each) {
      for (std::size_t i = 0; i < std::size(kShapeRows); ++i)
        if (wanted(kShapeRows[i].parameter)) each(static_cast<Shape>(i));
    };
    const auto of_contact = [](ShapeParameter p) {
      return p == ShapeParameter::kContactShare || p == ShapeParameter::kContactLength;
    };
    every_shape(of_contact, [&](Shape shape) {
      for (double contact = kLeastFitContact; contact < kMostContact + 0.01; contact += kContactStep)
        every_reach(shape, 1.0, contact);
    });
    every_shape([](ShapeParameter p) { return p == ShapeParameter::kNone; },
                [&](Shape shape) { every_reach(shape, 1.0, 0.0); });
    every_shape([](ShapeParameter p) { return p == ShapeParameter::kVolume; },
                [&](Shape shape) {
                  for (double volume = 0.0; volume < 1.01; volume += 0.1) every_reach(shape, volume, 0.0);
                });
  };
  try_between(kLeastFittedReach, kUsualReach);
  if (reach <= 0 && best.of_depth > kGoodShape) try_between(kUsualReach, kWidestReach);
  return best;
}

ForceFit fit_force(const std::vector<PressedPlace>& places) {
  Eigen::Index count = 0;
  double deepest = 0.0;
  for (const PressedPlace& each : places)
    for (const PressedTissue& press : each.presses) {
      ++count;
      deepest = std::max(deepest, press.depth);
    }
  ForceFit best;
  best.error = 1e30;
  if (count == 0) return best;
  for (std::size_t i = 0; i < std::size(kSpringRows); ++i) {
    const auto spring = static_cast<SpringLaw>(i);
    const bool cubic = reads_key(spring, "cubic"), stiffening = reads_key(spring, "stiffening");
    if (has_arm(spring) || reads_key(spring, "table")) continue;
    std::vector<FitParameter> boxes{{1.0, 0.1, 10.0, 1.0}};
    const double scale = cubic ? 1 / (deepest * deepest) : 1 / deepest;
    if (cubic) boxes.push_back({0.1 * scale, 0.0, 100 * scale, scale});
    if (stiffening) boxes.push_back({0.1 * scale, -5 * scale, 20 * scale, scale});
    const LeastSquares fit = least_squares(boxes, count, [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
      RestoringLaw law{spring};
      if (cubic) law.cubic = p[1];
      if (stiffening) law.stiffening = exponential_alpha(p[1]);
      Eigen::Index k = 0;
      for (const PressedPlace& each : places)
        for (const PressedTissue& press : each.presses)
          r[k++] = p[0] * each.stiffness * -law.force(-press.depth) / press.force - 1;
    });
    const double error = std::sqrt(fit.sum / static_cast<double>(count));
    if (error < 0.98 * best.error) best = {spring, fit.p[0], fit.p.size() > 1 ? fit.p[1] : 0.0, error};
  }
  return best;
}

std::vector<PressPlace> scatter(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                const std::vector<std::uint8_t>& allowed) {
  std::vector<double> sum;
  double total = 0.0;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 p = dvec3(mesh.position(t.x));
    const bool good = allowed[t.x] && allowed[t.y] && allowed[t.z];
    total += good ? 0.5 * length(cross(dvec3(mesh.position(t.y)) - p, dvec3(mesh.position(t.z)) - p)) : 0.0;
    sum.push_back(total);
  }
  std::vector<PressPlace> out;
  if (!(total > 0)) return out;
  for (std::size_t i = 0; i < count; ++i) {
    // Stratified by area. The mesh order, a space-filling curve, spreads the strata over the surface.
    const double at = total * (static_cast<double>(i) + next_share(seed)) / static_cast<double>(count);
    const auto triangle = static_cast<std::uint32_t>(std::upper_bound(sum.begin(), sum.end(), at) - sum.begin());
    double b1 = next_share(seed), b2 = next_share(seed);
    if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
    out.push_back(place_at(mesh, std::min<std::uint32_t>(triangle, static_cast<std::uint32_t>(sum.size()) - 1),
                           {1 - b1 - b2, b1, b2}));
  }
  return out;
}

std::vector<std::uint32_t> farthest_vertices(const Mesh& mesh, std::size_t count) {
  std::vector<std::uint32_t> out;
  std::vector<double> distance(mesh.vertex_count, 1e300);
  std::uint32_t next = 0;
  while (out.size() < std::min<std::size_t>(count, mesh.vertex_count)) {
    out.push_back(next);
    double most = -1.0;
    std::uint32_t then = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const dvec3 away = dvec3(mesh.position(v)) - dvec3(mesh.position(out.back()));
      distance[v] = std::min(distance[v], dot(away, away));
      if (distance[v] > most) most = distance[v], then = v;
    }
    if (!(most > 0)) break;
    next = then;
  }
  return out;
}

std::vector<double> spread(const Mesh& mesh, const std::vector<PressPlace>& at, const std::vector<double>& value) {
  std::vector<double> out(mesh.vertex_count);
  std::vector<std::pair<double, std::size_t>> near;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    near.clear();
    for (std::size_t i = 0; i < at.size(); ++i) {
      const dvec3 away = dvec3(mesh.position(v)) - at[i].position;
      const double turned = 1 - dot(dvec3(mesh.normal(v)), at[i].normal);
      near.emplace_back(dot(away, away) * (1 + 4 * turned), i);
    }
    const std::size_t count = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    // Fits a plane to the logarithms, with lengths scaled by the distance; a small regularisation keeps its slope
    // small.
    const double size = std::sqrt(near[count - 1].first) + 1e-12;
    Eigen::Matrix4d normal = Eigen::Vector4d(1e-9, 0.02, 0.02, 0.02).asDiagonal();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double least = 1e300, most = -1e300;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [distance, k] = near[i];
      const dvec3 away = (at[k].position - dvec3(mesh.position(v))) / size;
      const Eigen::Vector4d row(1.0, away.x, away.y, away.z);
      const double weight = 1 / (distance / (size * size) + 1e-4), y = std::log(value[k]);
      normal += weight * row * row.transpose();
      right += weight * y * row;
      least = std::min(least, y);
      most = std::max(most, y);
    }
    out[v] = std::exp(std::clamp(normal.ldlt().solve(right)[0], least, most));
  }
  return out;
}

}  // namespace pliant
