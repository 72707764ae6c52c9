// Distances along the surface: error against closed forms and exact paths, independence of the history.
#include "systems/touch/collide/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "runtime/parallel.h"
#include "scenes/exact_distance.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/arc_reach.h"
#include "systems/touch/model/dent.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::Stage;

Primitive grid(int n, double size, const std::function<dvec3(double, double)>& place) {
  Primitive p;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      p.position.push_back(
          vec3(place((static_cast<double>(i) / n - 0.5) * size, (static_cast<double>(j) / n - 0.5) * size)));
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), c = a + static_cast<std::uint32_t>(n) + 1;
      for (const std::uint32_t k : {a, c, a + 1, a + 1, c, c + 1}) p.index.push_back(k);
    }
  }
  return p;
}

Mesh built(const Primitive& primitive) {
  auto mesh = build_mesh("surface", std::span(&primitive, 1), mat4(1));
  EXPECT_TRUE(mesh.ok());
  return std::move(mesh->mesh);
}

struct SurfacePlace {
  std::uint32_t triangle = 0;
  dvec3 p{0}, normal{0};
};
SurfacePlace some_place(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  SurfacePlace place;
  place.triangle = static_cast<std::uint32_t>(random() % mesh.triangles.size());
  dvec3 share(unit(random), unit(random), 0);
  if (share.x + share.y > 1) share = dvec3(1 - share.x, 1 - share.y, 0);
  share.z = 1 - share.x - share.y;
  for (int i = 0; i < 3; ++i) {
    place.p += share[i] * dvec3(mesh.position(mesh.triangles[place.triangle][i]));
    place.normal += share[i] * dvec3(mesh.normal(place.triangle, i));
  }
  place.normal = normalize(place.normal);
  return place;
}

// Offsets around places of a mesh, as a tick makes them.
struct FieldAround {
  FieldAround(const Mesh& m, double r, const SurfaceWays* known = nullptr) : mesh(m), reach(r) {
    object.visited.assign(mesh.zone_count(), 0);
    if (known) {
      ways = *known;
    } else {
      ways.sides = sides_of(mesh);
      ways.hubs = chart_hubs(mesh, reach);
      ways.arc_reach = arc_reach(mesh, ways.sides, object, reach);
    }
    march.size(mesh);
    chart.size(mesh);
    offset.size(mesh);
    zones.reserve(mesh.zone_count());
  }
  FieldSource look(const SurfacePlace& place) {
    clear_offsets(zones, offset);
    FieldSource source;
    source.center = vec3(place.p);
    source.normal = vec3(place.normal);
    source.inv_reach2 = static_cast<float>(1 / (reach * reach));
    const uvec3 c = mesh.triangles[place.triangle];
    const std::uint32_t own[] = {c.x / kZoneSize, c.y / kZoneSize, c.z / kZoneSize};
    flood(mesh, source.center, reach, own, object, zones);
    return source;
  }
  // True: by arcs.
  bool fill(const SurfacePlace& place) {
    const FieldSource source = look(place);
    return fill_offsets(mesh, ways, place.triangle, source, zones, march, chart, offset);
  }
  // Marched from the place itself.
  void from_the_place(const SurfacePlace& place) {
    const FieldSource source = look(place);
    march_chart(mesh, ways.sides, place.triangle, source.center, static_cast<float>(reach), march, chart);
    for (const std::uint32_t zone : zones) chart_offsets(mesh, zone, source, vec2(0), chart, offset);
  }
  const Mesh& mesh;
  double reach;
  ObjectState object;
  SurfaceWays ways;
  March march;
  Chart chart;
  Offsets offset;
  std::vector<std::uint32_t> zones;
};

struct DistanceError {
  double squares = 0, worst = 0, count = 0;
  double rms() const { return std::sqrt(squares / std::max(count, 1.0)); }
  // Shares of the reach, over the vertices that either puts within it.
  void add(const FieldAround& around, const std::vector<double>& truth) {
    for (std::uint32_t v = 0; v < around.mesh.vertex_count; ++v) {
      const double is = std::min<double>(around.reach, length(around.offset[v])),
                   should = std::min(around.reach, truth[v]);
      if (around.mesh.area[v] == 0 || (is == around.reach && should == around.reach)) continue;
      const double off = std::abs(is - should) / around.reach;
      squares += off * off, worst = std::max(worst, off), count += 1;
    }
  }
};

using TrueDistance = std::function<std::vector<double>(const Mesh&, const SurfacePlace&, double reach)>;

std::vector<double> exact(const Mesh& mesh, const SurfacePlace& place, double reach) {
  return ExactDistance(mesh).from(place.triangle, place.p, 1.2 * reach);
}
TrueDistance closed_form(const std::function<double(dvec3, dvec3)>& distance) {
  return [distance](const Mesh& mesh, const SurfacePlace& place, double) {
    std::vector<double> out;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) out.push_back(distance(place.p, dvec3(mesh.position(v))));
    return out;
  };
}

struct Case {
  std::string name;
  Primitive primitive;
  double reach;
  TrueDistance truth = exact;
};

// An organ of the corpus, where there is one.
void add_organ(std::vector<Case>& all) {
  const std::filesystem::path path = std::filesystem::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Kidney_L.glb";
  if (!std::filesystem::exists(path)) return;
  const auto level = load_level(path);
  ASSERT_TRUE(level.ok());
  const Primitive* largest = nullptr;
  for (const LevelMesh& mesh : level->meshes)
    for (const Primitive& p : mesh.primitives)
      if (!largest || p.position.size() > largest->position.size()) largest = &p;
  ASSERT_NE(largest, nullptr);
  Box box;
  for (const vec3& x : largest->position) box.add(x);
  all.push_back({"kidney", *largest, 0.08 * static_cast<double>(box.diagonal())});
}

std::vector<Case> surfaces() {
  const double R = 0.1;
  const auto arc = [](dvec3 p, dvec3 v) {
    return 0.1 * std::acos(std::clamp(dot(normalize(p), normalize(v)), -1.0, 1.0));
  };
  const auto helix = [](dvec3 p, dvec3 v) {
    return std::hypot(p.z - v.z, 0.1 * std::abs(std::atan2(p.x, p.y) - std::atan2(v.x, v.y)));
  };
  const auto waves = [](double x, double z) { return dvec3(x, 0.008 * std::sin(60 * x) * std::sin(50 * z), z); };
  std::vector<Case> all{
      {"sheet", scenes::sheet(60, 0.2), 0.03, closed_form([](dvec3 p, dvec3 v) { return length(p - v); })},
      {"sphere", scenes::sphere(30, R), 0.04, closed_form(arc)},
      {"cylinder",
       grid(80, 0.24, [=](double x, double z) { return dvec3(R * std::sin(x / R), R * std::cos(x / R), z); }), 0.04,
       closed_form(helix)},
      {"saddle", grid(80, 0.24, [](double x, double z) { return dvec3(x, 3 * (x * x - z * z), z); }), 0.04},
      {"waves", grid(80, 0.2, waves), 0.03},
      {"valley", scenes::valley(40, 0.16, 0.8), 0.03},
      {"box", scenes::slab(20, 0.1, 0.03), 0.03},
      {"coarse box", scenes::slab(1, 0.1, 0.1), 0.05},
  };
  add_organ(all);
  return all;
}

TEST(SurfaceDistance, ExactPathsOverABoxAndAroundItsEdgeAreThoseOfItsNet) {
  const Mesh mesh = built(scenes::slab(8, 0.1, 0.02));
  std::mt19937 random(4);
  ExactDistance exact_distance(mesh);
  int seen = 0;
  for (int k = 0; k < 400; ++k) {
    const SurfacePlace place = some_place(mesh, random);
    if (std::abs(place.p.y) > 1e-6) continue;  // on the upper face
    const std::vector<double> d = exact_distance.from(place.triangle, place.p, 0.1);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const dvec3 x(mesh.position(v));
      if (std::abs(x.y) < 1e-6 && length(x - place.p) < 0.099) EXPECT_NEAR(d[v], length(x - place.p), 1e-8);
      // On the side x = 0.05, straight over the common edge where that path meets it.
      const double over = 0.05 - place.p.x, down = -x.y, along = x.z - place.p.z;
      if (std::abs(x.x - 0.05) > 1e-6 || down < 1e-6 || over + down > 0.04 || std::abs(x.z) > 0.02 ||
          std::abs(place.p.z) > 0.02)
        continue;
      EXPECT_NEAR(d[v], std::hypot(over + down, along), 1e-8);
      ++seen;
    }
  }
  EXPECT_GT(seen, 20);
}

// The arcs, and a chart of the whole triangle, against a march from the place itself.
TEST(SurfaceDistance, IsAsExactAsAMarchFromTheFoot) {
  for (const Case& surface : surfaces()) {
    const Mesh mesh = built(surface.primitive);
    FieldAround around(mesh, surface.reach);
    std::mt19937 random(3);
    DistanceError filled, marched;
    int arcs = 0;
    constexpr int kPlaces = 24;
    for (int k = 0; k < kPlaces; ++k) {
      const SurfacePlace place = some_place(mesh, random);
      const std::vector<double> truth = surface.truth(mesh, place, surface.reach);
      arcs += around.fill(place);
      filled.add(around, truth);
      around.from_the_place(place);
      marched.add(around, truth);
    }
    std::printf("%-10s by arcs %2d of %d  rms %.1e worst %.1e   marched from the foot: rms %.1e worst %.1e\n",
                surface.name.c_str(), arcs, kPlaces, filled.rms(), filled.worst, marched.rms(), marched.worst);
    EXPECT_LE(filled.rms(), std::max(1.2 * marched.rms(), 4e-5)) << surface.name;
    EXPECT_LE(filled.worst, std::max(2.5 * marched.worst, 2e-3)) << surface.name;  // of one vertex
  }
}

TEST(SurfaceDistance, DependsOnThePlaceAloneToTheBit) {
  for (const Case& surface : surfaces()) {
    const Mesh mesh = built(surface.primitive);
    FieldAround warm(mesh, surface.reach);
    std::mt19937 random(8);
    for (int k = 0; k < 6; ++k) {
      const SurfacePlace place = some_place(mesh, random);
      for (int i = 0; i < 5; ++i) warm.fill(some_place(mesh, random));
      SurfacePlace beside = place;  // the same triangle
      beside.p = 0.5 * (place.p + dvec3(mesh.position(mesh.triangles[place.triangle].x)));
      warm.fill(beside);
      warm.fill(place);
      FieldAround cold(mesh, surface.reach, &warm.ways);
      cold.fill(place);
      for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
        ASSERT_EQ(warm.offset[v], cold.offset[v]) << surface.name << ' ' << v;
    }
  }
}

TEST(SurfaceDistance, TheChoiceOfTheWayDependsNotOnTheNumberOfThreads) {
  const Mesh mesh = built(scenes::sphere(60, 0.1));
  const std::vector<TriangleSide> sides = sides_of(mesh);
  ObjectState object;
  const unsigned before = thread_count();
  set_thread_count(1);
  const std::vector<float> one = arc_reach(mesh, sides, object, 0.02);
  set_thread_count(3);
  const std::vector<float> three = arc_reach(mesh, sides, object, 0.02);
  set_thread_count(before);
  EXPECT_EQ(one, three);
}

// [1] Mean of 1 - cos between the offsets and the gradient of their lengths, away from the foot.
double off_gradient(const FieldAround& around, double& count) {
  double off = 0;
  for (const uvec3& t : around.mesh.triangles) {
    double d[3];
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
      d[i] = length(around.offset[t[i]]);
      inside = inside && d[i] < around.reach && d[i] > 0.3 * around.reach;
    }
    if (!inside) continue;
    const dvec3 a(around.mesh.position(t.x)), b = dvec3(around.mesh.position(t.y)) - a,
                                              c = dvec3(around.mesh.position(t.z)) - a;
    const dvec3 n = cross(b, c), gradient = (d[1] - d[0]) * cross(c, n) + (d[2] - d[0]) * cross(n, b);
    dvec3 mean(0);
    for (int i = 0; i < 3; ++i) mean += dvec3(around.offset[t[i]]) / d[i];
    off += 1 - dot(normalize(gradient), normalize(mean));
    count += 1;
  }
  return off;
}

TEST(SurfaceDistance, OffsetsPointAlongTheGradientAsThoseOfAMarchFromTheFoot) {
  for (const Case& surface : surfaces()) {
    const Mesh mesh = built(surface.primitive);
    FieldAround around(mesh, surface.reach);
    std::mt19937 random(5);
    double filled = 0, marched = 0, count = 0, counted = 0;
    for (int k = 0; k < 12; ++k) {
      const SurfacePlace place = some_place(mesh, random);
      around.fill(place);
      filled += off_gradient(around, count);
      around.from_the_place(place);
      marched += off_gradient(around, counted);
    }
    if (count > 0) EXPECT_LE(filled / count, std::max(1.1 * marched / counted, 4e-3)) << surface.name;
  }
}

// A probe along a closed loop over bumps, whose arcs, charts and marches alternate: the work is that of friction alone.
TEST(SurfaceDistance, AClosedLoopGivesNoWork) {
  const auto waves = [](double x, double z) { return dvec3(x, 0.004 * std::sin(60 * x) * std::sin(50 * z), z); };
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.distance = Distance::kSurface;
  d.friction_static = d.friction_sliding = 0;
  d.contact_damping = 0;
  const Entity surface = stage.add(grid(80, 0.2, waves), d);
  const auto at = [&](double s) {
    const double x = 0.04 * std::cos(s), z = 0.04 * std::sin(s);
    return waves(x, z) - dvec3(0, 0.0015, 0);
  };
  const Entity probe = stage.add_probe(at(0) + dvec3(0, 0.003, 0));
  stage.prepare();
  stage.tick();
  stage.move(probe, at(0), 0.05);
  stage.wait(0.5);
  constexpr int kTicks = 4000;
  const auto stream_here = [&] { return stage.field(surface).stream; };
  const auto first = stream_here();
  scenes::WorkMeter meter;
  double most = 0;
  for (int i = 0; i <= kTicks; ++i) {
    stage.place(probe, at(2 * 3.14159265358979 * i / kTicks));
    stage.tick();
    meter.add(stage.read(probe));
    most = std::max(most, length(stage.read(probe).force));
  }
  ASSERT_GT(most, 0.01);
  EXPECT_LT(std::abs(meter.work()), 1e-3 * most * 0.25);  // of force times way
  stage.wait(1.0);
  const auto last = stream_here();
  double apart = 0;
  for (std::size_t v = 0; v < first.size(); ++v) apart = std::max<double>(apart, std::abs(first[v].w - last[v].w));
  EXPECT_LT(apart, 1e-5 * 0.0015);  // the same place, the same field
}

}  // namespace
}  // namespace pliant
