// pliant inspect: describes a file, whether it can be touched, and its problems.
#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stop_token>
#include <thread>

#include "content/keys/enum_words.h"
#include "content/keys/unused_keys.h"
#include "content/level/device_request.h"
#include "content/level/device_use.h"
#include "content/level/level_budget.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/tet_file.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/files/content_folder.h"
#include "player/run/tool_words.h"
#include "player/verbs/inspect_fit.h"
#include "player/verbs/inspect_panorama.h"
#include "player/verbs/inspect_tets.h"
#include "player/verbs/verbs.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kTissueTime{2000};  // total time for previews of bare meshes as tissue

// Requests stop through its token after a time limit.
class Deadline {
 public:
  explicit Deadline(std::chrono::milliseconds time)
      : timer_([this, time](const std::stop_token& done) {
          std::unique_lock lock(mutex_);
          if (!over_.wait_for(lock, done, time, [] { return false; })) source_.request_stop();
        }) {}
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::mutex mutex_;
  std::condition_variable_any over_;
  std::jthread timer_;  // last member: ended first
};

// One node with a mesh, built for touch: in world scale, welded and cleaned.
struct ObjectReport {
  std::string name;
  bool deformable = false;
  std::size_t file_vertices = 0, file_triangles = 0;
  std::string refused;  // the reason why it cannot be touched; empty: it can
  Mesh mesh;
  MeshReport report;
  Box box;                // [m] world
  OrderedJson as_tissue;  // of a bare mesh; null: the time limit was reached
};

std::vector<ObjectReport> inspect_objects(const Level& level) {
  std::vector<ObjectReport> objects;
  const std::vector<mat4> world = world_matrices(level);
  const bool bare = !level.has_pliant();
  const LevelBudget budget(level);
  const Deadline deadline(kTissueTime);
  double triangles = 0.0, surfaces = 0.0;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (node.mesh < 0 || !node.in_scene) continue;
    const LevelMesh& source = level.meshes[static_cast<std::size_t>(node.mesh)];
    ObjectReport object;
    object.name = node.name.empty() ? source.name : node.name;
    object.deformable = node.deformable.has_value();
    for (const Primitive& primitive : source.primitives) {
      object.file_vertices += primitive.position.size();
      object.file_triangles += primitive.index.size() / 3;
    }
    // A room that is only drawn is seen from inside.
    const bool touched = bare || node.deformable || node.rigid_body || node.soft_body;
    // The same limit as in a run; here each surface would be built separately.
    std::optional<Note> many = LevelBudget::ask(limits::kSurfaces, surfaces += touched);
    if (!many) many = budget.ask_triangles(triangles += budget.of(node.mesh).triangles);
    if (many) {
      object.refused = many->message();
      objects.push_back(std::move(object));
      continue;
    }
    auto built = build_mesh(object.name, source.primitives, world[i],
                            {node.deformable ? node.deformable->crease_angle : 0.0, std::nullopt, touched});
    if (built) {
      if (bare && !deadline.token().stop_requested()) object.as_tissue = describe_as_tissue(*built, deadline.token());
      object.mesh = std::move(built->mesh);
      object.report = built->report;
      object.box = object.mesh.box;
    } else {
      object.refused = built.error().sentence();
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

std::vector<std::string> problems(const ObjectReport& object) {
  std::vector<std::string> list;
  const auto add = [&](std::uint32_t count, const char* one, const char* many, const char* cure) {
    if (count) list.push_back(fmt::format("{} {}; {}", count, count == 1 ? one : many, cure));
  };
  if (!object.refused.empty()) list.push_back(object.refused);
  const MeshReport& r = object.report;
  add(r.joined_vertices, "border vertex", "border vertices", "joined with others that differ by rounding alone");
  add(r.degenerate_triangles, "degenerate triangle", "degenerate triangles", "dropped");
  add(r.duplicate_triangles, "duplicate triangle", "duplicate triangles", "dropped");
  add(r.flush_walls, "pair of triangles", "pairs of triangles",
      "dropped: parts of the mesh are flush there, and are one body");
  add(r.border_edges, "border edge", "border edges",
      "the surface is open there: it can be touched, but does not enclose a volume");
  add(r.non_manifold_edges, "non-manifold edge", "non-manifold edges",
      "more than two triangles, or two of opposite orientation, meet there");
  for (const std::optional<Note>& found : {winding_note(r), winding_doubt(r)})
    if (found) list.push_back(found->message());
  if (r.made_normals) list.push_back("no normals in the file; made from the faces");
  return list;
}

// Every crease is stored once per side.
std::size_t count_creases(const Mesh& mesh) {
  std::size_t sides = 0;
  for (const std::uint8_t edges : mesh.crease) sides += static_cast<std::size_t>(std::popcount(edges));
  return sides / 2;
}

OrderedJson to_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
}

OrderedJson describe_tools(const Level& level) {
  OrderedJson list = OrderedJson::array();
  for (const LevelNode& node : level.nodes)
    if (node.handle)
      list.push_back({{"name", node.name}, {"device", node.handle->device}, {"force", word_of(node.handle->force)}});
  return list;
}

std::set<std::string> extensions_of(const Level& level) {
  std::set<std::string> extensions;
  for (const LevelNode& node : level.nodes)
    for (const Extension& extension : extension_table())
      if (!extension.on_scene && extension.present(&node)) extensions.insert("PLIANT_" + extension.name);
  if (level.environment) extensions.insert("PLIANT_environment");
  return extensions;
}

// The complete result as JSON; the text form reads from it.
OrderedJson describe(const Level& level, const std::vector<ObjectReport>& objects) {
  OrderedJson json;
  Box box;
  std::size_t triangles = 0, vertices = 0;
  OrderedJson list = OrderedJson::array();
  bool touchable = false;
  for (const ObjectReport& object : objects) {
    box.add(object.box);
    triangles += object.file_triangles;
    vertices += object.file_vertices;
    touchable = touchable || object.refused.empty();
    list.push_back({{"name", object.name},
                    {"deformable", object.deformable},
                    {"file_vertices", object.file_vertices},
                    {"file_triangles", object.file_triangles},
                    {"vertices", object.mesh.vertex_count},
                    {"triangles", object.mesh.triangles.size()},
                    {"zones", object.mesh.zone_count()},
                    {"closed", object.mesh.closed},
                    {"mean_edge_m", object.mesh.mean_edge},
                    {"welded_vertices", object.report.welded_vertices},
                    {"joined_vertices", object.report.joined_vertices},
                    {"degenerate_triangles", object.report.degenerate_triangles},
                    {"duplicate_triangles", object.report.duplicate_triangles},
                    {"flush_walls", object.report.flush_walls},
                    {"border_edges", object.report.border_edges},
                    {"non_manifold_edges", object.report.non_manifold_edges},
                    {"turned_triangles", object.report.turned_triangles},
                    {"turned_parts", object.report.turned_parts},
                    {"unorientable_parts", object.report.unorientable_parts},
                    {"undecided_parts", object.report.undecided_parts},
                    {"creases", count_creases(object.mesh)},
                    {"bounds_m", to_json(object.box)},
                    {"problems", problems(object)},
                    {"as_tissue", object.as_tissue}});
  }
  std::vector<std::string> probes, devices;
  for (const LevelNode& node : level.nodes) {
    if (node.probe || node.handle) probes.push_back(node.name);
    if (node.device) devices.push_back(node.name);
  }

  json["file"] = level.path.string();
  json["nodes"] = level.nodes.size();
  json["meshes"] = level.meshes.size();
  json["vertices"] = vertices;
  json["triangles"] = triangles;
  json["materials"] = level.materials.size();
  json["images"] = level.images.size();
  json["extensions"] = extensions_of(level);
  json["probes"] = probes;
  json["devices"] = devices;
  json["tools"] = describe_tools(level);
  json["bounds_m"] = to_json(box);
  json["unit_hint"] = unit_hint(box, !level.has_pliant());
  json["touchable"] = touchable;
  json["bare_mesh"] = !level.has_pliant();
  json["objects"] = list;
  json["tissue"] = describe_tissue(level);
  std::vector<std::string> notes = level.notes;
  for (const Note& unused : unused_key_notes(level)) notes.push_back(unused.message());
  for (const DeviceFault& idle : find_unmoved_probes(level))
    notes.push_back("`" + level.nodes[idle.node].name + "` " + idle.what.message());
  OrderedJson asked_for = OrderedJson::array();
  for (const LevelRequest& asked : device_requests(level)) {
    asked_for.push_back({{"moves", asked.moves}, {"id", asked.id}, {"allowed", asked.request.allowed}});
    for (const std::string& sentence : asked.request.refused)
      notes.push_back("`" + asked.moves + "` asks for more than a level may: " + sentence);
  }
  json["device_ids"] = asked_for;
  json["notes"] = notes;
  return json;
}

std::string join(const OrderedJson& list) {
  std::string text;
  for (const OrderedJson& item : list) text += (text.empty() ? "" : ", ") + item.get<std::string>();
  return text.empty() ? "none" : text;
}

void print_text(const OrderedJson& json, const Box& box) {
  print("{}\n", json["file"].get<std::string>());
  print("  {} nodes, {} meshes, {} triangles, {} vertices, {} materials, {} images\n", json["nodes"].get<std::size_t>(),
        json["meshes"].get<std::size_t>(), json["triangles"].get<std::size_t>(), json["vertices"].get<std::size_t>(),
        json["materials"].get<std::size_t>(), json["images"].get<std::size_t>());
  print("  extensions: {}\n  probes: {}\n  devices: {}\n", join(json["extensions"]), join(json["probes"]),
        join(json["devices"]));
  if (!box.empty())
    print("  bounds: {:.4g} x {:.4g} x {:.4g} m about ({:.4g}, {:.4g}, {:.4g})\n", box.size().x, box.size().y,
          box.size().z, box.center().x, box.center().y, box.center().z);
  if (const std::string hint = json["unit_hint"]; !hint.empty()) print("  unit: {}\n", hint);
  std::size_t left_out = 0;
  for (const OrderedJson& object : json["objects"]) {
    print("  object {}: {} vertices (of {}), {} triangles (of {}), {} zones, {}{}\n", object["name"].get<std::string>(),
          object["vertices"].get<std::size_t>(), object["file_vertices"].get<std::size_t>(),
          object["triangles"].get<std::size_t>(), object["file_triangles"].get<std::size_t>(),
          object["zones"].get<std::size_t>(), object["closed"].get<bool>() ? "closed" : "open",
          object["deformable"].get<bool>() ? ", deformable" : "");
    for (const OrderedJson& problem : object["problems"]) print("    {}\n", problem.get<std::string>());
    print_as_tissue(object["as_tissue"]);
    left_out += json["bare_mesh"].get<bool>() && object["vertices"] != 0 && object["as_tissue"].is_null();
  }
  if (left_out > 0) print("  {} object{} not tried as tissue, to answer soon\n", left_out, left_out == 1 ? "" : "s");
  for (const OrderedJson& tool : json["tools"]) {
    const std::string device = tool["device"];
    print("  tool {}: {}, force {}\n", tool["name"].get<std::string>(),
          device.empty() ? "no device" : "device " + device, tool["force"].get<std::string>());
  }
  for (const OrderedJson& asked : json["device_ids"])
    print("  asks for a device: {} by `{}`\n", asked["moves"].get<std::string>(), asked["id"].get<std::string>());
  print_tissue(json["tissue"]);
  for (const OrderedJson& sentence : json["notes"]) print("  note: {}\n", sentence.get<std::string>());
  if (!json["touchable"].get<bool>())
    print("  cannot be touched: there is no triangle in the scene that is shown\n");
  else if (json["bare_mesh"].get<bool>())
    print("  can be touched as it is, with defaults sized to its bounds: `pliant run FILE`\n");
  else
    print("  can be touched: `pliant run FILE`\n");
}

}  // namespace

int inspect(const InspectOptions& options) {
  const auto path = find_level(options.file);
  if (!path) return fail(kFailed, path.error());
  if (options.fit && (is_tet_file(*path) || is_panorama_file(*path)))
    return fail(kUsage, {"--fit", "is for levels and meshes that are touched", "leave it out"});
  if (options.unit && (is_tet_file(*path) || is_panorama_file(*path)))
    return fail(kUsage, {"--unit", "is for bare meshes", "leave it out"});
  if (is_tet_file(*path)) return inspect_tets(*path, options.json);
  if (is_panorama_file(*path)) return inspect_panorama(*path, options.json);
  auto level = load_level(*path);
  if (!level) return fail(kFailed, level.error());
  if (const Status unit = check_unit(*level, options.unit); !unit) return fail(kUsage, unit.error());
  scale_roots(*level, options.unit.value_or(1.0));
  const std::vector<ObjectReport> objects = inspect_objects(*level);
  OrderedJson json = describe(*level, objects);
  if (options.fit) {
    auto fit = describe_fit(*level, options.error);
    if (!fit) return fail(kFailed, fit.error());
    json["fit"] = std::move(*fit);
  }
  if (options.json) {
    print_json(json);
    return kDone;
  }
  Box box;
  for (const ObjectReport& object : objects) box.add(object.box);
  print_text(json, box);
  if (options.fit) print_fit(json["fit"]);
  return kDone;
}

}  // namespace pliant
