// Cost limits of a touch tick and of a nearest-point query. CPU time scatters: each figure is the median of batches
// with a confidence interval.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "content/mesh/mesh_build.h"
#include "lab/study/collision/study_collision.h"
#include "lab/study/hard/hard_case.h"
#include "lab/study/processor_time.h"
#include "lab/study/scale/tick_cost.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr std::size_t kBatches = 12;

// The true median of 12 batches lies between the third smallest and the third largest with 96 %, for any distribution:
// 1 - 2 (1 + 12 + 66) / 2^12.
struct Median {
  double value, low, high;
};
Median median_of(std::vector<double> batches) {
  ASSERT(batches.size() >= kBatches);
  batches.resize(kBatches);
  std::sort(batches.begin(), batches.end());
  return {0.5 * (batches[5] + batches[6]), batches[2], batches[9]};
}

HardFigure figure_of(const Median& median, const std::string& where) {
  HardFigure figure;
  figure.add(median.value, where);
  figure.between(median.low, median.high);
  figure.looked_at(fmt::format("{} batches", kBatches));
  return figure;
}

// 2,000 vertices awake on a surface of 1e6 vertices, or 1e5 in a brief study.
HardFigure tick(const HardSetting& setting, std::vector<double> TickCost::*batches) {
  const int ticks = setting.brief ? 1000 : 10'000;  // per batch
  const TickCost cost = measure_tick(setting.brief ? 100'000 : 1'000'000, 2000, static_cast<int>(kBatches) * ticks,
                                     static_cast<int>(kBatches));
  return figure_of(median_of(cost.*batches), fmt::format("{} vertices, {:.0f} awake", cost.vertices, cost.awake));
}
HardFigure half_of_ticks(const HardSetting& setting) {
  return tick(setting, &TickCost::batch_p50_us);
}
HardFigure most_ticks(const HardSetting& setting) {
  return tick(setting, &TickCost::batch_p99_us);
}

// On spheres of 1e5 and 1e6 vertices, from random points within 4 mm as in FCPW's benchmark, so that the cache does not
// contain the data of the last query. The figure is the time over FCPW's on the sphere where the ratio is larger.
template <class Query>
HardFigure queries(const HardSetting& setting, Query query) {
  HardFigure worst;
  for (const PublishedQuery& published : kFcpw) {
    if (setting.brief && published.vertices > 100'000) continue;
    const Primitive p = scenes::sphere(static_cast<int>(std::lround(std::sqrt(published.vertices / 6.0))), 0.1);
    const auto built = build_mesh("sphere", std::span(&p, 1), mat4(1));
    ASSERT(built.ok());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<dvec3> points;
    for (int i = 0; i < 5000; ++i) {
      const double out = 0.1 + 0.004 * unit(random);
      const dvec3 away(unit(random), unit(random), unit(random));
      points.push_back(out * normalize(away));
    }
    std::vector<double> batches;
    double off = 0.0;
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
      const std::uint64_t begin = processor_ns();
      for (const dvec3& x : points) off = std::max(off, std::abs(query(built->mesh, x) - std::abs(length(x) - 0.1)));
      batches.push_back(static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(points.size()) /
                        published.scalar_us);
    }
    worst.need(off < 0.5 * static_cast<double>(built->mesh.mean_edge), "a query found another place");
    const Median median = median_of(batches);
    if (median.value <= worst.value()) continue;
    worst.add(median.value, fmt::format("{:g} us on {} vertices; FCPW {:g} us", median.value * published.scalar_us,
                                        built->mesh.vertex_count, published.scalar_us));
    worst.between(median.low, median.high);
  }
  worst.looked_at(fmt::format("{} batches", kBatches));
  return worst;
}

HardFigure nearest_queries(const HardSetting& setting) {
  return queries(setting, [](const Mesh& mesh, dvec3 x) { return nearest(mesh, x, 1.0).distance(); });
}
HardFigure closest_queries(const HardSetting& setting) {
  return queries(setting, [](const Mesh& mesh, dvec3 x) { return std::sqrt(closest_flat(mesh, x, 1.0).distance2); });
}

}  // namespace

std::vector<HardCase> hard_cost() {
  constexpr const char* kTick = "methods.md 3.10: cost of a tick";
  constexpr const char* kQuery = "methods.md 3.10: cost of the global nearest query";
  return {
      {"HalfOfTheTicksTakeNoMoreThanTenMicroseconds", kTick,
       "2,000 of 1e6 vertices awake (of 1e5 with --quick): half of the ticks, median of 12 batches", "us", 10,
       half_of_ticks, "", true},
      {"NearlyAllTicksTakeNoMoreThanThirtyMicroseconds", kTick,
       "2,000 of 1e6 vertices awake (of 1e5 with --quick): 99 % of the ticks, median of 12 batches", "us", 30,
       most_ticks, "", true},
      {"TheNearestQueryTakesAtMostTwiceTheTimePublishedOfFcpw", kQuery,
       "P1's contact vertex by the tree, from nothing, spheres of 1e5 and 1e6 vertices (1e5 with --quick): time over "
       "FCPW's scalar one, published for a closest point and another machine; median of 12 batches",
       "of it [1]", 2, nearest_queries, "", true},
      {"TheClosestPointTakesAtMostTwiceTheTimePublishedOfFcpw", kQuery,
       "the closest point of the flat triangles, which is what FCPW finds: the same", "of it [1]", 2, closest_queries,
       "", true},
  };
}

}  // namespace pliant
