#include "player/study/study_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "player/progress.h"
#include "player/study/processor_time.h"
#include "player/study/studies.h"
#include "systems/touch/foot.h"
#include "systems/touch/surface_query.h"
#include "systems/touch/triangle_tree.h"

namespace pliant {
namespace {

constexpr double kDepth = 0.003;  // [m]
constexpr double kWobble = 0.002;

// Follows a point behind a surface and says what is felt there, per stiffness: the depth along its direction. [m]
class Follower {
 public:
  Follower(const Mesh& mesh, FeltSurface felt, dvec3 start) : mesh_(mesh), felt_(felt) {
    const FlatPoint flat = closest_flat(mesh, start, 1.0);
    hint_ = flat.triangle;
    if (felt == FeltSurface::kVirtualVertex) vertex_ = nearest(mesh, start, 1.0);
    if (felt == FeltSurface::kPatches) foot_ = descend(mesh, flat.triangle, flat.barycentric, start);
  }
  dvec3 felt(dvec3 x) {
    if (felt_ == FeltSurface::kPatches) {
      foot_ = descend(mesh_, foot_.triangle, foot_.barycentric, x);
      return -foot_.height * foot_.normal;
    }
    if (felt_ == FeltSurface::kVirtualVertex) {
      vertex_ = track(mesh_, vertex_, x).point;
      return -vertex_.height * vertex_.normal;
    }
    const FlatPoint flat = closest_flat(mesh_, x, 1.0, hint_);
    hint_ = flat.triangle;
    const uvec3 t = mesh_.triangles[flat.triangle];
    dvec3 place(0), normal(0);
    for (int i = 0; i < 3; ++i) {
      place += flat.barycentric[i] * dvec3(mesh_.position(t[i]));
      normal += flat.barycentric[i] * dvec3(mesh_.normal(t[i]));
    }
    if (felt_ == FeltSurface::kFacets) return place - x;
    return length(place - x) * normalize(normal);
  }

 private:
  const Mesh& mesh_;
  FeltSurface felt_;
  std::uint32_t hint_ = FlatPoint::kNone;
  SurfaceFoot vertex_;
  Foot foot_;
};

// How the force of a felt surface differs from the true one, over a loop.
struct Loop {
  double least = 1e30, most = 0.0, square = 0.0, turned = 0.0, work = 0.0, us = 0.0;
};
Loop go_around(const Mesh& mesh, const SmoothSurface& surface, FeltSurface felt, int samples, double wobble) {
  std::vector<dvec3> places, forces;
  std::vector<SmoothSurface::Point> truth;
  for (int i = 0; i <= samples; ++i) {
    const double s = static_cast<double>(i % samples) / samples;
    truth.push_back(surface.loop(s));
    places.push_back(truth.back().p - (kDepth + wobble * std::sin(10 * M_PI * s)) * truth.back().n);
  }
  Follower follower(mesh, felt, places[0]);
  const std::uint64_t begin = processor_ns();
  for (const dvec3& x : places) forces.push_back(follower.felt(x));
  Loop loop;
  loop.us = static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(places.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double size = length(forces[i]);
    loop.least = std::min(loop.least, size);
    loop.most = std::max(loop.most, size);
    const double angle = std::atan2(length(cross(forces[i], truth[i].n)), dot(forces[i], truth[i].n)) * 180 / M_PI;
    loop.square += angle * angle / static_cast<double>(forces.size());
    loop.turned = std::max(loop.turned, angle);
    if (i > 0) loop.work += 0.5 * dot(forces[i] + forces[i - 1], places[i] - places[i - 1]);
  }
  return loop;
}

enum SurfaceError { kRipple, kDirection, kWork, kErrors };
struct Kind {
  const char *study, *error, *axis;
  double least, most;
  double FeltErrors::*value;
};
constexpr Kind kKinds[kErrors] = {
    {"surfaces", "ripple", "ripple of the force's size, of the true force [1]", 1e-6, 1.0, &FeltErrors::ripple},
    {"surfaces_direction", "direction_deg", "RMS angle to the true force [degree]", 1e-4, 10.0, &FeltErrors::direction},
    {"surfaces_work", "loop_work", "work of a closed loop, of the energy stored [1]", 1e-9, 1.0, &FeltErrors::work},
};

std::string size_of(std::size_t triangles) {
  return triangles >= 1000 ? fmt::format("{:.0f}k", static_cast<double>(triangles) / 1000) : std::to_string(triangles);
}

// A felt surface on a mesh of one shape, or the worst of all shapes.
struct Felt {
  std::string shape;
  FeltSurface felt;
  std::size_t triangles;
  FeltErrors errors;
};

std::string shapes_csv(const std::vector<Felt>& all) {
  std::string csv = "shape,triangles,surface,ripple,direction_deg,largest_angle_deg,loop_work,cost_us\n";
  for (const Felt& each : all)
    csv += fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.3g}\n", each.shape, each.triangles, name_of(each.felt),
                       each.errors.ripple, each.errors.direction, each.errors.turned, each.errors.work, each.errors.us);
  return csv;
}

void join(FeltErrors& all, const FeltErrors& one) {
  all.ripple = std::max(all.ripple, one.ripple);
  all.direction = std::max(all.direction, one.direction);
  all.turned = std::max(all.turned, one.turned);
  all.work = std::max(all.work, one.work);
  all.us = std::max(all.us, one.us);
}

ParetoTable table_of(const std::vector<Felt>& worst, const Kind& kind) {
  ParetoTable table;
  table.study = kind.study;
  table.title = "a probe 3 mm behind spheres, tori and saddles of 5k to 500k triangles: the worst of the three";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us a query that follows the probe]";
  table.error_name = kind.error;
  table.error_axis = kind.axis;
  table.more = {"triangles"};
  table.least_error = kind.least;
  table.most_error = kind.most;
  for (const Felt& each : worst)
    table.rows.push_back({size_of(each.triangles),
                          each.errors.us,
                          each.errors.*kind.value,
                          name_of(each.felt),
                          {std::to_string(each.triangles)}});
  return table;
}

// How an error falls from the least mesh to the largest.
std::string falls_of(const std::vector<Felt>& worst, const Kind& kind) {
  std::string words;
  for (const FeltSurface felt : kFeltSurfaces) {
    const Felt *first = nullptr, *last = nullptr;
    for (const Felt& each : worst) {
      if (each.felt != felt) continue;
      if (!first) first = &each;
      last = &each;
    }
    words += fmt::format("{}{} {:.2g} to {:.2g}", words.empty() ? "" : ", ", name_of(felt), first->errors.*kind.value,
                         last->errors.*kind.value);
  }
  return words;
}

}  // namespace

const char* name_of(FeltSurface felt) {
  constexpr const char* kNames[] = {"flat facets", "force shading", "interpolated contact vertex", "curved patches"};
  return kNames[static_cast<std::size_t>(felt)];
}

FeltErrors feel(const Mesh& mesh, const SmoothSurface& surface, FeltSurface felt, int samples) {
  const Loop even = go_around(mesh, surface, felt, samples, 0.0),
             uneven = go_around(mesh, surface, felt, samples, kWobble);
  FeltErrors out;
  out.ripple = (even.most - even.least) / kDepth;
  out.direction = std::sqrt(even.square);
  out.turned = even.turned;
  const double deepest = kDepth + kWobble;
  out.work = std::abs(uneven.work) / (0.5 * deepest * deepest);
  out.us = std::min(even.us, uneven.us);
  return out;
}

Status study_surfaces(OutputFolder& out, bool quick, const Interrupt& interrupt) {
  const std::vector<int> sizes =
      quick ? std::vector{5'000, 20'000, 50'000} : std::vector{5'000, 15'000, 50'000, 150'000, 500'000};
  const int samples = quick ? 20'000 : 100'000;
  Progress progress("study surfaces");
  std::vector<Felt> all, worst;
  double done = 0.0;
  for (const int size : sizes) {
    for (const FeltSurface felt : kFeltSurfaces) worst.push_back({"worst", felt, static_cast<std::size_t>(size), {}});
    Felt* const of_size = worst.data() + worst.size() - std::size(kFeltSurfaces);
    for (const SmoothSurface& surface : {smooth_sphere(), smooth_torus(), smooth_saddle()}) {
      if (interrupt.requested()) return interrupted();
      const Mesh mesh = surface.mesh(size);
      for (std::size_t i = 0; i < std::size(kFeltSurfaces); ++i) {
        all.push_back(
            {surface.name, kFeltSurfaces[i], mesh.triangles.size(), feel(mesh, surface, kFeltSurfaces[i], samples)});
        join(of_size[i].errors, all.back().errors);
      }
      progress.update((done += 1.0) / (3.0 * static_cast<double>(sizes.size())));
    }
  }
  if (const Status written = write_text(out, "surfaces_shapes.csv", shapes_csv(all)); !written) return written;
  for (const Kind& kind : kKinds) {
    ParetoTable table = table_of(worst, kind);
    table.sentences.push_back(fmt::format("From {} to {} triangles: {}.",
                                          size_of(static_cast<std::size_t>(sizes.front())),
                                          size_of(static_cast<std::size_t>(sizes.back())), falls_of(worst, kind)));
    const auto& least = *std::min_element(worst.begin(), worst.end(), [&](const Felt& a, const Felt& b) {
      return a.errors.*kind.value < b.errors.*kind.value;
    });
    table.sentences.push_back(fmt::format("The least is {:.2g}, of {} at {} triangles, for {:.2g} us.",
                                          least.errors.*kind.value, name_of(least.felt), size_of(least.triangles),
                                          least.errors.us));
    if (const Status written = write_study(out, table); !written) return written;
  }
  return Done{};
}

}  // namespace pliant
