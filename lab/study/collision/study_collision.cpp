#include "lab/study/collision/study_collision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "lab/console/progress.h"
#include "lab/study/collision/upward_tree.h"
#include "lab/study/corpus_folder.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "runtime/assert.h"
#include "scenes/brute_force.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr double kStrictRoom = 1e-9;  // [1] of the mesh's size

// Follows a path with one search method.
class Searcher {
 public:
  Searcher(const Mesh& mesh, Search search, dvec3 start) : mesh_(mesh), search_(search), within_(mesh.box.diagonal()) {
    const FlatPoint flat = closest_flat(mesh, start, within_);
    vertex_ = nearest(mesh, start, within_);
    foot_ = descend(mesh, flat.triangle, flat.barycentric, start);
    hint_ = flat.triangle;
    corner_.vertex = mesh.triangles[flat.triangle].x;
    if (search != Search::kUpwards && search != Search::kUpwardsBall) return;
    tree_.emplace(mesh);
    at_vertex_.resize(mesh.vertex_count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) at_vertex_[mesh.triangles[t][i]] = t;
  }
  // [m] From the last query to the vertex found for it, by P1's tree.
  double to_vertex() const { return std::sqrt(corner_.distance2); }
  // [m] Distance to the surface as found by the search.
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
      case Search::kUpwards:
      case Search::kUpwardsBall:
        corner_ =
            search_ == Search::kUpwards ? tree_->as_printed(x, corner_.vertex) : tree_->repaired(x, corner_.vertex);
        return around(x);
      case Search::kBrute:
        break;
    }
    UNREACHABLE();
  }

 private:
  // [m] To the triangles around the vertex found.
  double around(dvec3 x) const {
    double least = within_;
    around_vertex(mesh_, corner_.vertex, at_vertex_[corner_.vertex],
                  [&](std::uint32_t t) { least = std::min(least, closest_point(mesh_, t, x).distance()); });
    return least;
  }

  const Mesh& mesh_;
  Search search_;
  double within_;
  SurfaceFoot vertex_;
  Foot foot_;
  std::uint32_t hint_ = FlatPoint::kNone;
  std::optional<UpwardTree> tree_;
  std::vector<std::uint32_t> at_vertex_;  // a triangle
  UpwardTree::Answer corner_;
};

// Number of triangles of a sphere, as "200k", "2M".
std::string short_count(std::uint32_t triangles) {
  return triangles >= 1'000'000 ? fmt::format("{}M", triangles / 1'000'000) : fmt::format("{}k", triangles / 1000);
}

struct CollisionBody {
  std::string name;
  std::function<Result<Mesh>()> mesh;
};

CollisionBody sphere(std::uint32_t triangles) {
  return {"sphere " + short_count(triangles), [triangles]() -> Result<Mesh> {
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

std::vector<CollisionBody> bodies(StudySize size) {
  const bool quick = size != StudySize::kFull;
  std::vector<CollisionBody> all;
  for (const std::uint32_t triangles : {1'000u, 10'000u, 100'000u, 200'000u, 1'000'000u, 2'000'000u})
    if (triangles <= (size == StudySize::kSmall ? 10'000u : quick ? 100'000u : 2'000'000u))
      all.push_back(sphere(triangles));
  if (size == StudySize::kSmall) return all;
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

const char* label_of(Search search) {
  constexpr const char* kLabels[] = {"walk: vertex",        "walk: patches", "tree: vertex", "tree: closest",
                                     "tree: closest, hint", "P1, printed",   "P1, repaired", "brute force"};
  return kLabels[static_cast<std::size_t>(search)];
}

struct Row {
  std::string body;
  std::size_t triangles;
  Search search;
  SearchFigures figures;
};

struct ScatteredRow {
  PublishedQuery published;
  SearchFigures figures;
};

ParetoTable table_of(const std::vector<Row>& rows, const std::vector<ScatteredRow>& scattered) {
  ParetoTable table;
  table.study = "collision";
  table.title =
      "a probe slides over spheres of 1k to 2M triangles and meshes of the corpus: where is the surface? Scattered: "
      "points anywhere near a sphere, FCPW's figures published for another machine";
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us a query]";
  table.error_name = "misses";
  table.error_axis = "share of queries that miss a nearer place [1]; none: at half of one";
  table.more = {"search", "triangles", "checked", "misses_strict"};
  table.joined = false;
  table.front_by_group = true;
  const auto add = [&](const std::string& body, const char* label, const char* search, std::size_t triangles,
                       const SearchFigures& figures) {
    table.rows.push_back(
        {label,
         figures.us,
         figures.misses,
         body,
         {search, static_cast<std::int64_t>(triangles), static_cast<std::int64_t>(figures.checked), figures.strict}});
    if (figures.checked > 0) table.rows.back().floor = 0.5 / static_cast<double>(figures.checked);
  };
  for (const Row& row : rows) {
    if (row.body == "sphere 1M" || row.body == "bunny" || row.body == "heart") table.drawn.push_back(table.rows.size());
    add(row.body, label_of(row.search), name_of(row.search), row.triangles, row.figures);
  }
  for (const auto& [published, figures] : scattered) {
    const std::uint32_t triangles = 2 * published.vertices;
    const std::string body = fmt::format("sphere {}, scattered", short_count(triangles));
    for (std::size_t i = 0; i < 3; ++i) table.drawn.push_back(table.rows.size() + i);
    add(body, label_of(Search::kClosest), name_of(Search::kClosest), triangles, figures);
    for (const auto& [label, us] : {std::pair{"FCPW, scalar", published.scalar_us}, {"FCPW, SIMD", published.simd_us}})
      add(body, label, "FCPW's tree: closest point, as published", triangles,
          {us, 0.0, std::numeric_limits<double>::quiet_NaN(), 0});
  }
  if (scattered.empty()) table.drawn.clear();
  return table;
}

std::string range_of(const std::vector<Row>& rows, Search search) {
  double low = 1e30, high = 0.0;
  for (const Row& row : rows)
    if (row.search == search) low = std::min(low, row.figures.us), high = std::max(high, row.figures.us);
  return fmt::format("{} {} to {}", name_of(search), two_digits(low), two_digits(high));
}

std::vector<std::string> sentences_of(const std::vector<Row>& rows, const std::vector<ScatteredRow>& scattered) {
  std::string first = "Microseconds a query that follows the probe, over all meshes:", second;
  for (const Search search : kSearches) first += (search == kSearches[0] ? " " : ", ") + range_of(rows, search);
  for (const Search search : kSearches) {
    const Row* worst = nullptr;
    for (const Row& row : rows)
      if (row.search == search && (!worst || row.figures.misses > worst->figures.misses)) worst = &row;
    if (worst->figures.misses > 0.0)
      second += fmt::format("{}{} misses a nearer place in up to {:.2g} % ({})", second.empty() ? "" : ", ",
                            name_of(search), 100 * worst->figures.misses, worst->body);
  }
  second = second.empty() ? "Nothing is missed" : second + ", the others in none";
  if (!scattered.empty()) second += "; scattered queries of the closest point take";
  for (const auto& [published, figures] : scattered)
    second += fmt::format("{} {:.2g} us on {} triangles (FCPW as published, another machine: {:g} scalar, {:g} SIMD)",
                          second.ends_with("take") ? "" : ",", figures.us, short_count(2 * published.vertices),
                          published.scalar_us, published.simd_us);
  second[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(second[0])));
  return {first + ".", second + "."};
}

}  // namespace

const char* name_of(Search search) {
  constexpr const char* kNames[] = {
      "local walk: contact vertex",  "local walk: curved patches",      "tree: contact vertex",
      "tree: closest point",         "tree: closest point from a hint", "P1's tree, upwards as printed",
      "P1's tree, upwards repaired", "brute force: contact vertex"};
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
    if (length(next - on) > 0.1 * step) heading = next - on;  // otherwise it hit an edge: new direction
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
  for (std::size_t i = 0; i < way.size(); i += truth.every) {
    truth.flat.push_back(brute.closest(way[i], L).distance());
    double least2 = L * L;
    for (const uvec3& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const dvec3 d = dvec3(mesh.position(t[k])) - way[i];
        least2 = std::min(least2, dot(d, d));
      }
    truth.corner.push_back(std::sqrt(least2));
  }
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
  std::vector<double> found, corner;
  found.reserve(way.size());
  corner.reserve(way.size());
  const std::uint64_t begin = processor_ns();
  for (const dvec3& x : way) {
    found.push_back(searcher(x));
    corner.push_back(searcher.to_vertex());
  }
  out.us = static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(way.size());
  const bool vertex = search == Search::kWalk || search == Search::kTree;
  const bool upwards = search == Search::kUpwards || search == Search::kUpwardsBall;
  for (std::size_t i = 0; i < out.checked; ++i) {
    const double off = found[i * truth.every] - (vertex ? truth.vertex : truth.flat)[i];
    out.misses += off > kMissRoom * mesh.mean_edge;
    const double strictly = upwards ? corner[i * truth.every] - truth.corner[i] : off;
    out.strict += strictly > kStrictRoom * mesh.box.diagonal();
  }
  out.misses /= static_cast<double>(out.checked);
  out.strict /= static_cast<double>(out.checked);
  if (search == Search::kPatches) out.strict = std::numeric_limits<double>::quiet_NaN();
  return out;
}

SearchFigures search_scattered(std::uint32_t vertices, std::size_t queries, std::size_t checks) {
  const auto built = sphere(2 * vertices).mesh();
  ASSERT(built.ok());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<dvec3> points;
  for (std::size_t i = 0; i < queries; ++i)
    points.push_back((0.1 + 0.004 * unit(random)) * normalize(dvec3(unit(random), unit(random), unit(random))));
  SearchFigures out;
  out.us = 1e30;
  out.checked = checks;
  std::vector<double> found(queries);
  for (int round = 0; round < 3; ++round) {
    const std::uint64_t begin = processor_ns();
    for (std::size_t i = 0; i < queries; ++i) found[i] = closest_flat(*built, points[i], 1.0).distance2;
    out.us = std::min(out.us, static_cast<double>(processor_ns() - begin) * 1e-3 / static_cast<double>(queries));
  }
  const BruteForce brute(*built);
  for (std::size_t i = 0; i < checks; ++i) {
    const double off = std::sqrt(found[i]) - brute.closest(points[i], 1.0).distance();
    out.misses += (off > kMissRoom * built->mean_edge) / static_cast<double>(checks);
    out.strict += (off > kStrictRoom * built->box.diagonal()) / static_cast<double>(checks);
  }
  return out;
}

Status study_collision(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Progress progress("study collision");
  const bool full = size == StudySize::kFull;
  const std::vector<CollisionBody> all = bodies(size);
  std::vector<Row> rows;
  std::vector<ScatteredRow> scattered;
  double done = 0.0;
  const auto measured = [&] { progress.update((done += 1.0) / static_cast<double>(all.size() + std::size(kFcpw))); };
  for (const CollisionBody& body : all) {
    const auto mesh = body.mesh();
    if (!mesh) return mesh.error();
    const std::vector<dvec3> way = wander(*mesh, full ? 20'000 : 5'000);
    if (interrupt.requested()) return interrupted();
    // More checks where brute force is cheap.
    const std::size_t most = full ? 4'000 : 1'000,
                      checks = std::clamp(40'000'000 / mesh->triangles.size(), most / 10, most);
    const Truth truth = truth_along(*mesh, way, checks);
    for (const Search search : kSearches) {
      if (interrupt.requested()) return interrupted();
      rows.push_back({body.name, mesh->triangles.size(), search, search_along(*mesh, search, way, truth)});
    }
    measured();
  }
  for (const PublishedQuery& published : kFcpw) {
    if (!full) break;
    if (interrupt.requested()) return interrupted();
    scattered.push_back({published, search_scattered(published.vertices, 50'000, 200)});
    measured();
  }
  ParetoTable table = table_of(rows, scattered);
  table.sentences = sentences_of(rows, scattered);
  return write_study(out, table);
}

}  // namespace pliant
