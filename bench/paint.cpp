// Times of painting: opening the level, building the surface, a ray, a footprint, a dab of every mode, the end of a
// stroke, a fill and a refinement, from 2e4 triangles to 1e6. The error is the footprint's largest difference from arcs
// of the sphere.
//   bench_paint [--large] [--out FILE.json]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "content/level_file.h"
#include "editor/document/document.h"
#include "editor/paint/coarse.h"
#include "editor/paint/stroke.h"
#include "runtime/hash.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

// p50, p99 and the largest, CPU time in microseconds; building the surface and refining use several cores.
struct Times {
  std::vector<double> us;
  template <class Work>
  void add(Work work) {
    const double start = processor_ms();
    work();
    us.push_back((processor_ms() - start) * 1e3);
  }
  std::string text() const {
    return fmt::format("{:9.1f} {:9.1f} {:9.1f}", median(us), percentile(us, 0.99), percentile(us, 1.0));
  }
  std::string json() const {
    return fmt::format(R"({{"p50_us": {:.1f}, "p99_us": {:.1f}, "max_us": {:.1f}}})", median(us), percentile(us, 0.99),
                       percentile(us, 1.0));
  }
};

// Point i of 200, spread evenly over the sphere.
dvec3 place(int i) {
  const double z = 1 - (i + 0.5) / 100, angle = 2.399963 * i, ring = std::sqrt(1 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

// A level in which the mesh can be touched.
Level playable(const LevelMesh& mesh) {
  Level level;
  level.meshes.push_back(mesh);
  LevelNode node;
  node.name = "organ";
  node.mesh = 0;
  node.deformable.emplace();
  level.nodes.push_back(node);
  return level;
}

std::string measure(const LevelMesh& mesh, double edge) {
  std::string rows;
  const auto row = [&](const char* what, const Times& times, std::size_t count) {
    fmt::print("{:24} {} {:9}\n", what, times.text(), count);
    rows += fmt::format(R"({}"{}": {})", rows.empty() ? "" : ", ", what, times.json());
  };
  Times open, make, ray, foot, end, filled, refined;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("bench_{}.glb", ::getpid());
  if (!save_level(playable(mesh), file).ok()) return {};
  for (int i = 0; i < 3; ++i) open.add([&] { (void)Document::open(file); });
  std::filesystem::remove(file);
  make.add([&] { (void)PaintSurface::make(mesh, dmat3(1)); });
  const PaintSurface surface = *PaintSurface::make(mesh, dmat3(1));
  const std::size_t vertices = surface.mesh().vertex_count;
  fmt::print("{} triangles; times in us: p50, p99, max; vertices\n", surface.mesh().triangles.size());
  row("open", open, vertices);
  row("surface", make, vertices);

  // About 5,000 vertices, or a third of the sphere.
  const double radius = 2 * std::asin(std::sqrt(std::min(5000.0 / double(vertices), 0.3)));
  MarchWork work;
  double error = 0.0;
  std::size_t reached = 0;
  for (int i = 0; i < 200; ++i) {
    const dvec3 from = place(i);
    SurfaceHit hit;
    ray.add([&] { hit = surface.hit({3.0 * from, -from}); });
    std::vector<ReachedVertex> found;
    foot.add([&] { found = surface.footprint(hit, radius, {}, work); });
    const dvec3 center = normalize(hit.point);
    for (const ReachedVertex& r : found) {
      const dvec3 p = normalize(dvec3(surface.mesh().position(r.vertex)));
      error = std::max(error, std::abs(double(r.distance) - std::acos(std::min(1.0, dot(p, center)))) / radius);
    }
    reached = found.size();
  }
  row("ray", ray, 1);
  row("footprint", foot, reached);

  const MeshPaint before = paint_of(mesh, surface, PaintAttribute::kStiffness);
  Hash hash;
  for (const auto& [name, mode] :
       {std::pair{"dab, set", BrushMode::kSet}, {"dab, add", BrushMode::kAdd}, {"dab, smooth", BrushMode::kSmooth}}) {
    Stroke stroke(surface, before, {.radius = radius, .mode = mode, .value = 3.0});
    Times dab;
    stroke.move({3.0 * place(0), -place(0)});
    for (int i = 0; i < 200; ++i) {
      // A quarter of a radius farther: one more dab.
      const double angle = 0.2501 * radius * (i + 1);
      const dvec3 from(std::sin(angle), 0.1, std::cos(angle));
      const std::uint32_t dabs = stroke.dabs();
      dab.add([&] { stroke.move({3.0 * from, -from}); });
      if (stroke.dabs() != dabs + 1) dab.us.pop_back();
    }
    row(name, dab, reached);
    MeshPaint after;
    end.add([&] { after = stroke.after(); });
    for (const float v : after.layers[0].flatten()) hash.add(v);
  }
  row("end of a stroke", end, vertices);
  const SurfaceHit top = surface.hit({{0, 0, 3}, {0, 0, -1}});
  for (int i = 0; i < 5; ++i)
    filled.add([&] { (void)with(before, fill(before, surface, surface.connected(top), 2.0)); });
  row("fill", filled, vertices);
  refined.add([&] { (void)refine_under(mesh, surface, top, 0.3 * radius, 0.3 * edge); });
  row("refine", refined, vertices);
  fmt::print("{:24} {:.4f} of the radius; hash {:016x}\n\n", "error", error, hash.value());
  return fmt::format(R"({{"triangles": {}, {}, "error": {:.5f}, "hash": "{:016x}"}})", surface.mesh().triangles.size(),
                     rows, error, hash.value());
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  const BenchArguments arguments(argc, argv, "--large");
  std::string json;
  for (const int n : arguments.on ? std::vector<int>{41, 129, 290} : std::vector<int>{41, 129}) {
    const LevelMesh mesh{"sphere", {scenes::sphere(n, 1.0)}};
    json += (json.empty() ? "[" : ",\n ") + measure(mesh, 1.5 / n);
  }
  arguments.save(json + "]\n");
}
