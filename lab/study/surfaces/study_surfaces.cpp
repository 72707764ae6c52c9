#include "lab/study/surfaces/study_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/console/progress.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "lab/study/surfaces/corrected_normals.h"
#include "lab/study/surfaces/singular_surfaces.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr double kDepth = 0.003;  // [m]
constexpr double kWobble = 0.002;
constexpr double kSettled = 0.05;  // [1] relative change at half the samples below which the work has converged

// Follows a point behind a surface and evaluates the felt force per stiffness: the depth along its direction. [m]
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

// Deviation of the felt force from the true one, over a loop.
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
  double FeltErrors::*value;
};
constexpr Kind kKinds[kErrors] = {
    {"surfaces", "ripple", "ripple of the force's size, of the true force [1]", &FeltErrors::ripple},
    {"surfaces_direction", "direction_deg", "RMS angle to the true force [degree]", &FeltErrors::direction},
    {"surfaces_work", "loop_work", "work of a closed loop, of the energy stored [1]", &FeltErrors::work},
};

std::string size_of(std::size_t triangles) {
  return triangles >= 1000 ? fmt::format("{:.0f}k", static_cast<double>(triangles) / 1000) : std::to_string(triangles);
}

// A felt surface on a mesh of one shape, or the worst over all shapes.
struct Felt {
  std::string shape;
  FeltSurface felt;
  std::size_t triangles;
  FeltErrors errors;
};

std::string shapes_csv(const std::vector<Felt>& all) {
  std::string csv =
      "shape,triangles,surface,ripple,direction_deg,largest_angle_deg,loop_work,loop_work_floor,cost_us\n";
  for (const Felt& each : all)
    csv += fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.3g}\n", each.shape, each.triangles,
                       name_of(each.felt), each.errors.ripple, each.errors.direction, each.errors.turned,
                       each.errors.work, each.errors.floor, each.errors.us);
  return csv;
}

void join(FeltErrors& all, const FeltErrors& one) {
  all.ripple = std::max(all.ripple, one.ripple);
  all.direction = std::max(all.direction, one.direction);
  all.turned = std::max(all.turned, one.turned);
  all.work = std::max(all.work, one.work);
  all.floor = std::max(all.floor, one.floor);
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
  const bool work = kind.value == &FeltErrors::work;
  table.more = {"triangles"};
  if (work) table.more.push_back("loop_work_floor");
  for (const Felt& each : worst) {
    table.rows.push_back({size_of(each.triangles),
                          each.errors.us,
                          each.errors.*kind.value,
                          name_of(each.felt),
                          {static_cast<std::int64_t>(each.triangles)}});
    if (!work) continue;
    table.rows.back().more.emplace_back(each.errors.floor);
    table.rows.back().floor = each.errors.floor;
  }
  return table;
}

std::string words_of(const ParetoRow& row) {
  return fmt::format("{}{:.2g}", row.error < row.floor ? "at most " : "", row.resolved());
}

// Error decrease from the smallest mesh to the largest.
std::string falls_of(const ParetoTable& table) {
  std::string words;
  for (const FeltSurface felt : kFeltSurfaces) {
    const ParetoRow *first = nullptr, *last = nullptr;
    for (const ParetoRow& row : table.rows) {
      if (row.group != name_of(felt)) continue;
      if (!first) first = &row;
      last = &row;
    }
    words += fmt::format("{}{} {} to {}", words.empty() ? "" : ", ", name_of(felt), words_of(*first), words_of(*last));
  }
  return words;
}

// P1's corrected normals and those of the dented triangles: the worse of a sheet and a sphere.
Status study_normals(OutputFolder& out, bool full) {
  ParetoTable table;
  table.study = "surfaces_normals";
  table.title =
      "normals of a dent 0.1 of its reach deep, on a sheet and a sphere of 5 to 40 edges a reach: the worse of the two";
  table.cost_name = "cost_ns_per_vertex";
  table.cost_axis = "cost with the heights [ns a vertex]";
  table.error_name = "angle_deg";
  table.error_axis = "RMS angle to the dented surface's normals [degree]";
  table.more = {"edges_per_reach"};
  std::string csv = "surface,edges_per_reach,depth_over_reach,normals,rms_deg,worst_deg,cost_ns_per_vertex\n", words;
  for (const DrawnNormal normal : kDrawnNormals) {
    for (const int edges : {5, 10, 20, 40}) {
      if (!full && edges > 10) continue;
      NormalErrors worse;
      for (const bool sphere : {false, true}) {
        for (const double depth : {0.02, 0.1, 0.3}) {
          const NormalErrors e = normals_on({sphere, edges, depth}, normal, full ? 9 : 2);
          csv += fmt::format("{},{},{:g},{},{:.9g},{:.9g},{:.3g}\n", sphere ? "sphere" : "sheet", edges, depth,
                             name_of(normal), e.rms, e.worst, e.ns);
          if (depth != 0.1) continue;
          worse.rms = std::max(worse.rms, e.rms);
          worse.ns = std::max(worse.ns, e.ns);
        }
      }
      table.rows.push_back(
          {fmt::format("{}", edges), worse.ns, worse.rms, name_of(normal), {static_cast<std::int64_t>(edges)}});
    }
    const std::size_t count = table.rows.size(), sizes = full ? 4 : 2;
    words += fmt::format("{}{} {:.2g} to {:.2g} degrees for {} to {} ns a vertex", words.empty() ? "" : ", ",
                         name_of(normal), table.rows[count - sizes].error, table.rows[count - 1].error,
                         two_digits(table.rows[count - sizes].cost), two_digits(table.rows[count - 1].cost));
  }
  table.sentences.push_back("From 5 to " + std::string(full ? "40" : "10") + " edges a reach: " + words + ".");
  if (const Status written = write_text(out, "surfaces_normals_all.csv", csv); !written) return written;
  return write_study(out, table);
}

// A box by drifting normals and by feet.
Status study_creases(OutputFolder& out, bool full) {
  ParetoTable table;
  table.study = "surfaces_creases";
  table.title = "a probe around the edges of a box of 100 x 40 mm, 1 to 5 mm behind its faces";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us a query that follows the probe]";
  table.error_name = "loop_work";
  table.error_axis = "work of a closed loop, of the energy stored [1]";
  table.more = {"cells", "direction_deg", "steepest"};
  table.least_error = 1e-6;
  std::string words;
  for (const CreaseFelt felt : kCreaseFelt) {
    double work = 0.0, direction = 0.0, steepest = 0.0;
    for (const int cells : {4, 8, 16, 32, 64}) {
      if (!full && cells > 8) continue;
      const CreaseErrors e = feel_creases(cells, felt, full ? 40'000 : 4'000);
      table.rows.push_back({fmt::format("{} cells", cells),
                            e.us,
                            e.work,
                            name_of(felt),
                            {static_cast<std::int64_t>(cells), e.direction, e.steepest}});
      work = std::max(work, e.work);
      direction = std::max(direction, e.direction);
      steepest = std::max(steepest, e.steepest);
    }
    words +=
        fmt::format("{}{} at most {:.2g} of the energy, {:.2g} degrees off a face's normal, a slope of {} stiffnesses",
                    words.empty() ? "" : "; ", name_of(felt), work, direction, two_digits(steepest));
  }
  table.sentences.push_back("Over 4 to " + std::string(full ? "64" : "8") + " cells a side: " + words + ".");
  return write_study(out, table);
}

}  // namespace

const char* name_of(FeltSurface felt) {
  constexpr const char* kNames[] = {"flat facets", "force shading", "interpolated contact vertex", "curved patches"};
  return kNames[static_cast<std::size_t>(felt)];
}

FeltErrors feel(const Mesh& mesh, const SmoothSurface& surface, FeltSurface felt, int samples) {
  const Loop even = go_around(mesh, surface, felt, samples, 0.0);
  const Loop uneven = go_around(mesh, surface, felt, samples, kWobble);
  // One small change may be chance; after two of them the sum has converged.
  double work = uneven.work, change = 0.0, before = std::numeric_limits<double>::infinity();
  for (int more = 2; more <= kMostWork; more *= 2) {
    const double finer = go_around(mesh, surface, felt, more * samples, kWobble).work;
    change = std::max(std::abs(finer - work), 0.5 * before);
    before = std::abs(finer - work);
    work = finer;
    if (change <= kSettled * std::abs(work)) break;
  }
  FeltErrors out;
  out.ripple = (even.most - even.least) / kDepth;
  out.direction = std::sqrt(even.square);
  out.turned = even.turned;
  const double deepest = kDepth + kWobble;
  out.work = std::abs(work) / (0.5 * deepest * deepest);
  out.floor = change / (0.5 * deepest * deepest);
  out.us = std::min(even.us, uneven.us);
  return out;
}

Status study_surfaces(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const bool small = size == StudySize::kSmall, full = size == StudySize::kFull;
  const std::vector<int> sizes = small   ? std::vector{5'000, 10'000}
                                 : !full ? std::vector{5'000, 20'000, 50'000}
                                         : std::vector{5'000, 15'000, 50'000, 150'000, 500'000};
  const int samples = small ? 1'000 : !full ? 10'000 : 100'000;
  Progress progress("study surfaces");
  std::vector<Felt> all, worst;
  double done = 0.0;
  for (const int triangles : sizes) {
    for (const FeltSurface felt : kFeltSurfaces)
      worst.push_back({"worst", felt, static_cast<std::size_t>(triangles), {}});
    Felt* const of_size = worst.data() + worst.size() - std::size(kFeltSurfaces);
    for (const SmoothSurface& surface : {smooth_sphere(), smooth_torus(), smooth_saddle()}) {
      if (interrupt.requested()) return interrupted();
      const Mesh mesh = surface.mesh(triangles);
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
                                          size_of(static_cast<std::size_t>(sizes.back())), falls_of(table)));
    // Among the smallest errors that are resolved.
    const ParetoRow* least = nullptr;
    bool open = false;
    for (const ParetoRow& row : table.rows) {
      open = open || row.error < row.floor;
      if (row.error >= row.floor && (!least || row.error < least->error)) least = &row;
    }
    std::string words = least ? fmt::format("The least is {:.2g}, of {} at {} triangles, for {:.2g} us", least->error,
                                            least->group, least->label, least->cost)
                              : std::string("None is resolved");
    if (open)
      words += "; open points are at what the sum over samples resolves: those loops give out no more than that";
    table.sentences.push_back(words + ".");
    if (const Status written = write_study(out, table); !written) return written;
  }
  if (interrupt.requested()) return interrupted();
  if (const Status written = study_normals(out, full); !written) return written;
  if (interrupt.requested()) return interrupted();
  return study_creases(out, full);
}

}  // namespace pliant
