#include "player/study/study_collision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "player/progress.h"
#include "player/study/corpus_folder.h"
#include "player/study/processor_time.h"
#include "player/study/studies.h"
#include "runtime/assert.h"
#include "systems/touch/foot.h"
#include "systems/touch/surface_query.h"
#include "systems/touch/triangle_tree.h"
#include "tests/scenes/brute_force.h"
#include "tests/scenes/scenes.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// Follows a way by one search.
class Searcher {
 public:
  Searcher(const Mesh& mesh, Search search, dvec3 start) : mesh_(mesh), search_(search), within_(mesh.box.diagonal()) {
    const FlatPoint flat = closest_flat(mesh, start, within_);
    vertex_ = nearest(mesh, start, within_);
    foot_ = descend(mesh, flat.triangle, flat.barycentric, start);
    hint_ = flat.triangle;
  }
  // How far it says that the surface is. [m]
  double operator()(dvec3 x) {
    switch (search_) {
      case Search::kWalk:
        vertex_ = track(mesh_, vertex_, x).point;
        return vertex_.distance();
      case Search::kPatches:
        foot_ = descend(mesh_, foot_.triangle, foot_.barycentric, x);
        return std::abs(foot_.height);
      case Search::kTree:
        return nearest(mesh_, x, within_).distance();
      case Search::kClosest:
        return std::sqrt(closest_flat(mesh_, x, within_).distance2);
      case Search::kClosestHint: {
        const FlatPoint flat = closest_flat(mesh_, x, within_, hint_);
        hint_ = flat.triangle;
        return std::sqrt(flat.distance2);
      }
      case Search::kBrute:
        break;
    }
    UNREACHABLE();
  }

 private:
  const Mesh& mesh_;
  Search search_;
  double within_;
  SurfaceFoot vertex_;
  Foot foot_;
  std::uint32_t hint_ = FlatPoint::kNone;
};

struct CollisionBody {
  std::string name;
  std::function<Result<Mesh>()> mesh;
};

CollisionBody sphere(std::uint32_t triangles) {
  const std::string size =
      triangles >= 1'000'000 ? fmt::format("{}M", triangles / 1'000'000) : fmt::format("{}k", triangles / 1000);
  return {"sphere " + size, [triangles]() -> Result<Mesh> {
            const Primitive p = scenes::sphere(static_cast<int>(std::lround(std::sqrt(triangles / 12.0))), 0.1);
            auto built = build_mesh("sphere", std::span(&p, 1), mat4(1));
            if (!built) return built.error();
            return std::move(built->mesh);
          }};
}

// The largest part of a file of the corpus.
CollisionBody file(const std::string& name, const fs::path& path) {
  return {name, [path]() -> Result<Mesh> {
            auto level = load_level(path);
            if (!level) return level.error();
            make_touchable(*level);
            auto world = spawn(*level);
            if (!world) return world.error();
            Mesh* largest = nullptr;
            for (auto [entity, d] : world->registry.view<Deformable>())
              if (Mesh& m = world->meshes[d.mesh]; !largest || m.triangles.size() > largest->triangles.size())
                largest = &m;
            if (!largest) return Error{path.string(), "has no surface"};
            return std::move(*largest);
          }};
}

std::vector<CollisionBody> bodies(bool quick) {
  std::vector<CollisionBody> all;
  for (const std::uint32_t triangles : {1'000u, 10'000u, 100'000u, 200'000u, 1'000'000u, 2'000'000u})
    if (!quick || triangles <= 100'000) all.push_back(sphere(triangles));
  const fs::path corpus = corpus_folder() / "meshes-valid";
  for (const auto& [name, path] : {std::pair{"cow", "spot/spot_triangulated.obj"},
                                   {"bunny", "pmndrs/bunny.glb"},
                                   {"hand", "webxr-hand/right.glb"},
                                   {"kidney", "hra/VH_F_Kidney_L.glb"},
                                   {"heart", "hra/VH_F_Heart.glb"},
                                   {"liver", "hra/VH_F_Liver.glb"}})
    if (fs::exists(corpus / path) && (!quick || std::string(name) < "h")) all.push_back(file(name, corpus / path));
  return all;
}

struct Row {
  std::string body;
  std::size_t triangles;
  Search search;
  SearchFigures figures;
};

ParetoTable table_of(const std::vector<Row>& rows) {
  ParetoTable table;
  table.study = "collision";
  table.title =
      "a probe wanders about spheres of 1k to 2M triangles and meshes of the corpus: where is the surface? (FCPW: "
      "figures "
      "published for another machine)";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us a query]";
  table.error_name = "misses";
  table.error_axis = "share of queries that miss a nearer place [1]; 0.001 and none on the edge";
  table.more = {"triangles", "checked"};
  table.joined = false;
  table.least_error = 1e-3;
  table.most_error = 1.0;
  for (const Row& row : rows) {
    if (row.body == "sphere 10k" || row.body == "sphere 1M" || row.body == "bunny" || row.body == "heart")
      table.drawn.push_back(table.rows.size());
    table.rows.push_back({row.body,
                          row.figures.us,
                          row.figures.misses,
                          name_of(row.search),
                          {std::to_string(row.triangles), std::to_string(row.figures.checked)}});
  }
  for (const PublishedQuery& query : kFcpw)
    for (const bool simd : {false, true}) {
      table.drawn.push_back(table.rows.size());
      table.rows.push_back({fmt::format("{}, sphere {:g}M", simd ? "SIMD" : "scalar", 2e-6 * query.vertices),
                            simd ? query.simd_us : query.scalar_us,
                            0.0,
                            "FCPW: closest point by its tree",
                            {std::to_string(2 * query.vertices), "0"}});
    }
  return table;
}

std::string range_of(const std::vector<Row>& rows, Search search) {
  double low = 1e30, high = 0.0;
  for (const Row& row : rows)
    if (row.search == search) low = std::min(low, row.figures.us), high = std::max(high, row.figures.us);
  return fmt::format("{} {:.2g} to {:.2g}", name_of(search), low, high);
}

std::vector<std::string> sentences_of(const std::vector<Row>& rows) {
  std::string first = "Microseconds a query over all meshes:", missing;
  for (const Search search : kSearches) first += (search == kSearches[0] ? " " : ", ") + range_of(rows, search);
  for (const Search search : kSearches) {
    const Row* worst = nullptr;
    for (const Row& row : rows)
      if (row.search == search && (!worst || row.figures.misses > worst->figures.misses)) worst = &row;
    if (worst->figures.misses > 0.0)
      missing += fmt::format("{}{} misses a nearer place in up to {:.2g} % ({})", missing.empty() ? "" : "; ",
                             name_of(search), 100 * worst->figures.misses, worst->body);
  }
  std::string second = missing.empty() ? "Nothing is missed" : missing;
  for (const PublishedQuery& query : kFcpw)
    for (const Row& row : rows)
      if (row.search == Search::kClosest &&
          row.body == fmt::format("sphere {}", query.vertices == 100'000 ? "200k" : "2M"))
        second += fmt::format("; the closest point on {} takes {:.1f} times FCPW's scalar figure", row.body,
                              row.figures.us / query.scalar_us);
  return {first + ".", second + "."};
}

}  // namespace

const char* name_of(Search search) {
  constexpr const char* kNames[] = {
      "local walk: contact vertex", "local walk: curved patches",      "tree: contact vertex",
      "tree: closest point",        "tree: closest point from a hint", "brute force: contact vertex"};
  return kNames[static_cast<std::size_t>(search)];
}

std::vector<dvec3> wander(const Mesh& mesh, std::size_t ticks) {
  std::mt19937 random(23);
  std::normal_distribution<double> g;
  const double L = mesh.box.diagonal(), step = 5e-4 * L;
  const uvec3 first = mesh.triangles[static_cast<std::uint32_t>(random()) % mesh.triangles.size()];
  dvec3 on(mesh.position(first.x)), heading(dvec3(mesh.position(first.y)) - on);
  std::vector<dvec3> way;
  while (way.size() < ticks) {
    heading = normalize(heading) + 0.05 * dvec3(g(random), g(random), g(random));
    const FlatPoint flat = closest_flat(mesh, on + step * normalize(heading), L);
    const uvec3 t = mesh.triangles[flat.triangle];
    dvec3 next(0), normal(0);
    for (int i = 0; i < 3; ++i) {
      next += flat.barycentric[i] * dvec3(mesh.position(t[i]));
      normal += flat.barycentric[i] * dvec3(mesh.normal(t[i]));
    }
    if (length(next - on) > 0.1 * step) heading = next - on;  // else it ran into an edge: somewhere else
    on = next;
    const double out = 0.01 * std::sin(0.02 * static_cast<double>(way.size())) - 0.005;
    way.push_back(on + out * L * normalize(normal));
  }
  return way;
}

Truth truth_along(const Mesh& mesh, const std::vector<dvec3>& way, std::size_t checks) {
  const BruteForce brute(mesh);
  const double L = mesh.box.diagonal();
  Truth truth;
  truth.every = std::max<std::size_t>(1, way.size() / checks);
  const std::uint64_t begin = processor_ns();
  for (std::size_t i = 0; i < way.size(); i += truth.every) truth.vertex.push_back(brute.nearest(way[i], L).distance());
  truth.us = static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(truth.vertex.size());
  for (std::size_t i = 0; i < way.size(); i += truth.every) truth.flat.push_back(brute.closest(way[i], L).distance());
  return truth;
}

SearchFigures search_along(const Mesh& mesh, Search search, const std::vector<dvec3>& way, const Truth& truth) {
  SearchFigures out;
  out.checked = truth.vertex.size();
  if (search == Search::kBrute) {
    out.us = truth.us;
    return out;
  }
  Searcher searcher(mesh, search, way[0]);
  std::vector<double> found;
  found.reserve(way.size());
  const std::uint64_t begin = processor_ns();
  for (const dvec3& x : way) found.push_back(searcher(x));
  out.us = static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(way.size());
  const bool vertex = search == Search::kWalk || search == Search::kTree;
  // Patches bulge from the facets by less than that.
  const double room = search == Search::kPatches ? 0.25 * mesh.mean_edge : 1e-9 * mesh.box.diagonal();
  for (std::size_t i = 0; i < out.checked; ++i)
    out.misses += found[i * truth.every] > (vertex ? truth.vertex : truth.flat)[i] + room;
  out.misses /= static_cast<double>(out.checked);
  return out;
}

double closest_us(std::uint32_t vertices, std::size_t queries) {
  const auto built = sphere(2 * vertices).mesh();
  ASSERT(built.ok());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<dvec3> points;
  for (std::size_t i = 0; i < queries; ++i)
    points.push_back((0.1 + 0.004 * unit(random)) * normalize(dvec3(unit(random), unit(random), unit(random))));
  double least = 1e30, sum = 0.0;
  for (int round = 0; round < 3; ++round) {
    const std::uint64_t begin = processor_ns();
    for (const dvec3& x : points) sum += closest_flat(*built, x, 1.0).distance2;
    least = std::min(least, static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(queries));
  }
  ASSERT(sum >= 0.0);
  return least;
}

Status study_collision(OutputFolder& out, bool quick, const Interrupt& interrupt) {
  Progress progress("study collision");
  const std::vector<CollisionBody> all = bodies(quick);
  std::vector<Row> rows;
  double done = 0.0;
  for (const CollisionBody& body : all) {
    const auto mesh = body.mesh();
    if (!mesh) return mesh.error();
    const std::vector<dvec3> way = wander(*mesh, quick ? 5'000 : 20'000);
    if (interrupt.requested()) return interrupted();
    const Truth truth = truth_along(*mesh, way, quick ? 200 : 400);
    for (const Search search : kSearches) {
      if (interrupt.requested()) return interrupted();
      rows.push_back({body.name, mesh->triangles.size(), search, search_along(*mesh, search, way, truth)});
    }
    progress.update((done += 1.0) / static_cast<double>(all.size()));
  }
  ParetoTable table = table_of(rows);
  table.sentences = sentences_of(rows);
  return write_study(out, table);
}

}  // namespace pliant
