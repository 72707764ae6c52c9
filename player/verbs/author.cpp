// pliant author: makes a first touchable level from an organ's mesh.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "content/author/edit_nodes.h"
#include "content/author/hand_bones.h"
#include "content/author/instruments.h"
#include "content/author/organ.h"
#include "content/author/presets.h"
#include "content/author/save_script.h"
#include "content/author/staging.h"
#include "content/author/touchable.h"
#include "content/files/file_io.h"
#include "content/keys/extension_table.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "content/tets/tet_parts.h"
#include "engine/choice/pin_advice.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "player/verbs/verbs.h"
#include "systems/prepare_world.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr double kShare = 0.15;  // [1] of the object that is pinned

std::string in_quotes(const std::string& name) {
  return "`" + name + "`";
}

// The shown nodes that have a surface, the largest first.
std::vector<std::int32_t> objects(const Level& level) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  std::vector<std::pair<float, std::int32_t>> found;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene || node.mesh < 0 ||
        !has_area(level.meshes[static_cast<std::size_t>(node.mesh)], dmat3(world[i])))
      continue;
    const std::int32_t number = static_cast<std::int32_t>(i);
    const ObjectFrame frame = object_frame(level, number);
    found.emplace_back(-frame.box.diagonal(), number);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::int32_t> out;
  for (const auto& [size, number] : found) out.push_back(number);
  return out;
}

Result<std::int32_t> find_object(const Level& level, const std::vector<std::int32_t>& all, const char* option,
                                 const std::string& name) {
  std::vector<std::string> names;
  for (const std::int32_t node : all) {
    names.push_back(level.nodes[static_cast<std::size_t>(node)].name);
    if (names.back() == name) return node;
  }
  std::string list;
  for (std::size_t i = 0; i < names.size() && i < 5; ++i) list += (i ? ", " : "") + in_quotes(names[i]);
  if (names.size() > 5) list += ", ...";
  const bool other =
      std::any_of(level.nodes.begin(), level.nodes.end(), [&](const LevelNode& node) { return node.name == name; });
  const std::string near = suggestion(name, names);
  const std::string where = fmt::format("{} {}", option, name), code = "name.unknown";
  if (other) return Error{where, "names a node without a surface", "nodes that have one: " + list, code};
  if (near.empty())
    return Error{where, "names a node that the file does not have", "those with a surface: " + list, code};
  return Error{where, "names a node that the file does not have", near, code};
}

// The nodes to create.
struct Plan {
  std::vector<std::int32_t> soft, surface;
  const TissuePreset* preset = nullptr;
  std::optional<Side> side;
  const Instrument* tool = nullptr;
  bool probe = false;
  std::optional<HandBones> hand;  // of the soft node
};

Result<Plan> plan_of_hand(const AuthorOptions& options, const Level& level) {
  const Result<std::int32_t> node = skinned_node(level);
  if (!node) return Error{options.in, node.error().what, node.error().cure};
  const Result<HandBones> hand = bones_of_skin(level, *node);
  if (!hand) return Error{options.in, hand.error().what, hand.error().cure};
  Plan plan;
  plan.soft = {*node};
  plan.preset = find_preset(options.preset.empty() ? "skin" : options.preset);
  plan.hand = *hand;
  return plan;
}

Result<Plan> plan_of(const AuthorOptions& options, const Level& level) {
  Plan plan;
  const std::vector<std::int32_t> all = objects(level);
  if (all.empty()) return Error{options.in, "has no surface that could be touched", "choose a file with a mesh"};
  if (options.hand) return plan_of_hand(options, level);
  for (const auto& [names, option, nodes] :
       {std::tuple(&options.soft, "--soft", &plan.soft), std::tuple(&options.surface, "--surface", &plan.surface)})
    for (const std::string& name : *names) {
      const Result<std::int32_t> node = find_object(level, all, option, name);
      if (!node) return node.error();
      if (std::count(plan.soft.begin(), plan.soft.end(), *node) +
          std::count(plan.surface.begin(), plan.surface.end(), *node))
        return Error{fmt::format("{} {}", option, name), "is asked for twice", "name a node once"};
      nodes->push_back(*node);
    }
  if (plan.soft.empty() && plan.surface.empty()) plan.soft.push_back(all.front());
  plan.preset = find_preset(options.preset.empty() ? "liver" : options.preset);
  if (!options.pin.empty() && plan.soft.empty())
    return Error{"--pin " + options.pin, "is for soft bodies, and --surface makes none", "use --soft, or leave it out"};
  if (options.pin != "none") plan.side = side_of(options.pin.empty() ? "bottom" : options.pin);
  // A tool touches bodies, a probe also surfaces.
  const std::string tool = !options.tool.empty() ? options.tool : plan.soft.empty() ? "none" : "rod";
  if (tool != "none") plan.tool = find_instrument(tool);
  if (plan.tool && plan.soft.empty())
    return Error{"--tool " + tool, "is for soft bodies, and --surface makes none", "use --soft, or --probe instead"};
  plan.probe = options.probe || !plan.tool;
  return plan;
}

std::string words_of_preset(const TissuePreset& preset) {
  return fmt::format("{} (Young's modulus {:g} kPa, of {:g} to {:g} measured)", preset.name, preset.young * 1e-3,
                     preset.low * 1e-3, preset.high * 1e-3);
}

// A scripted device: name, path and script file.
struct Led {
  std::string name;
  Path path;
  fs::path file;
};

// Parts inside the surface move with its dents.
DeformableParameters with_parts(DeformableParameters surface) {
  surface.carries = Carries::kInside;
  return surface;
}

Result<World> try_out(const Level& level) {
  Result<World> world = spawn(level);
  if (!world) return world;
  if (const Status status = prepare_world(*world); !status) return status.error();
  return world;
}

// If the pins support too little, advises on better ones.
void say_pins(const Level& level, std::int32_t node, const TetMesh& tets) {
  const SoftBody& body = *level.nodes[static_cast<std::size_t>(node)].soft_body;
  if (body.under_gravity != UnderGravity::kModelled || !tets.start.empty()) return;
  const std::vector<PinAdvice> advice = advise_pins(level, node);
  if (!advice.empty())
    note(fmt::format("pinned at the {} ({:g} % of its extent) it would sag by {:.2g} mm only: --pin {}",
                     word_of(advice.front().side), 100.0 * advice.front().share, 1e3 * advice.front().sag,
                     word_of(advice.front().side)));
}

void say_soft(const Level& level, const World& world, const Plan& plan) {
  for (const std::int32_t number : plan.soft) {
    const std::string& name = level.nodes[static_cast<std::size_t>(number)].name;
    for (auto [entity, body] : world.registry.view<const SoftBody>()) {
      const Name* its = world.registry.find<Name>(entity);
      if (!its || its->value != name) continue;
      const TetMesh& tets = world.tet_meshes[body.tets];
      const std::uint32_t parts = count_parts(tets);
      print("  {} is soft: {}; {} tetrahedra in {} part{}\n", in_quotes(name), words_of_preset(*plan.preset),
            tets.tets.size(), parts, parts == 1 ? "" : "s");
      if (plan.hand)
        print("    on {} bones with a hinge each; its palm is the handle\n", tets.rigid_counts.size());
      else if (plan.side)
        print("    pinned at the {}: {} of {} nodes, in {:g} % of its extent\n", word_of(*plan.side),
              tets.node_count() - tets.pinned_begin(), tets.node_count(), kShare * 100.0);
      else
        print("    not pinned: it falls until it lies on something\n");
      if (!tets.parts.empty()) {
        std::string names;
        for (std::size_t i = 0; i < tets.parts.size() && i < 3; ++i)
          if (const Name* part = world.registry.find<Name>(tets.parts[i].entity))
            names += (i ? ", " : "") + in_quotes(part->value);
        if (tets.parts.size() > 3) names += fmt::format(" and {} more", tets.parts.size() - 3);
        print("    takes along what lies inside of it: {}\n", names);
      }
      for (const Note& found : tets.report.notes) note(in_quotes(name) + ": " + found.message());
      for (const Note& found : tets.report.findings) note(in_quotes(name) + ": " + found.message());
      say_pins(level, number, tets);
    }
  }
}

void say_rest(const Level& level, const Plan& plan, const std::vector<Led>& led) {
  for (const std::int32_t number : plan.surface)
    print("  {} is a deformable surface: {}, {:.4g} N/m under a point\n",
          in_quotes(level.nodes[static_cast<std::size_t>(number)].name), words_of_preset(*plan.preset),
          surface_stiffness(*plan.preset));
  for (const Led& each : led)
    print("  {} follows {}, which {}; edit that, or lead it with the mouse in a window\n", in_quotes(each.name),
          each.file.filename().string(),
          plan.hand ? "closes and opens it by its grip" : "presses it in and lets it go");
}

// Names of meshes that are drawn only.
std::string only_drawn(const Level& level, const std::vector<std::int32_t>& all, const World& world) {
  std::set<std::int32_t> carried;  // entities are in the order of the scene's nodes
  std::size_t row = 0;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].in_scene && world.registry.has<Carried>(world.hierarchy.order()[row++].entity))
      carried.insert(static_cast<std::int32_t>(i));
  std::string list;
  std::size_t count = 0;
  for (const std::int32_t number : all) {
    const LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
    if (node.has_pliant() || carried.count(number)) continue;
    if (count++ < 3) list += (count > 1 ? ", " : "") + in_quotes(node.name);
  }
  if (count == 0) return {};
  if (count > 3) list += fmt::format(" and {} more", count - 3);
  return list + (count == 1 ? " is only drawn" : " are only drawn") + "; name more of them with --soft or --surface";
}

Result<std::int32_t> make_hand(Level& level, std::int32_t node, const Plan& plan) {
  if (const Status s = make_soft(level, node, soft_body_of(*plan.preset)); !s) return s.error();
  if (const Status s = put_on_bones(level, node, *plan.hand); !s) return s.error();
  return node;
}

// Everything except files. Nodes are found by name each time, because adding one may shift the others.
Result<std::vector<Led>> author_level(const AuthorOptions& options, Plan& plan, Level& level) {
  for (const std::int32_t node : plan.soft) {
    if (plan.hand) break;
    SoftBodyParameters tissue = as_modelled(soft_body_of(*plan.preset));
    if (!plan.side) tissue.under_gravity = UnderGravity::kFalls;
    if (const Status s = make_soft(level, node, tissue); !s) return s.error();
    if (plan.side)
      if (const Status s = pin(level, node, *plan.side, kShare); !s) return s.error();
  }
  for (const std::int32_t node : plan.surface)
    if (const Status s = make_touchable_surface(level, node, with_parts(surface_of(*plan.preset))); !s)
      return s.error();
  for (const std::vector<std::int32_t>* nodes : {&plan.soft, &plan.surface})
    for (const std::int32_t node : *nodes) add_look(level, node, *plan.preset);
  // New nodes become roots after all shown nodes. Nodes of other scenes come after them and are unchanged.
  const std::int32_t object = plan.soft.empty() ? plan.surface.front() : plan.soft.front();
  std::vector<Led> led;
  const auto lead = [&](Result<std::int32_t> node) -> Status {
    if (!node) return node.error();
    LevelNode& made = level.nodes[static_cast<std::size_t>(*node)];
    const fs::path out(options.out);
    led.push_back({made.name, plan.hand ? closing_path(level, *node) : press_path(level, *node, object),
                   out.parent_path() / (out.stem().string() + "_" + made.name + ".csv")});
    return Done{};
  };
  if (plan.hand)
    if (const Status s = lead(make_hand(level, object, plan)); !s) return s.error();
  if (plan.tool)
    if (const Status s = lead(add_instrument(level, plan.tool->kind, object)); !s) return s.error();
  if (plan.probe)
    if (const Status s = lead(add_probe(level, object)); !s) return s.error();
  const auto has = [&](const auto& member) {
    return std::any_of(level.nodes.begin(), level.nodes.end(),
                       [&](const LevelNode& node) { return node.in_scene && (node.*member).has_value(); });
  };
  if (!has(&LevelNode::light)) add_light(level, object);
  if (!has(&LevelNode::camera)) add_camera(level, object);
  if (level.about.empty())
    level.about = fmt::format("{}: {}, {}.", fs::path(options.in).stem().string(), plan.preset->name,
                              plan.hand   ? "a hand on bones that closes by its grip"
                              : plan.tool ? std::string("touched with a ") + plan.tool->word
                                          : "touched with a probe");
  return led;
}

Status write_all(const AuthorOptions& options, Level& level, const std::vector<Led>& led) {
  const Existing existing = options.force ? Existing::kReplace : Existing::kRefuse;
  std::error_code ignored;
  std::vector<fs::path> added;  // removed again if the level cannot be written
  const auto take_back = [&](Status failed) {
    for (const fs::path& each : added) fs::remove(each, ignored);
    return failed;
  };
  for (const Led& each : led) {
    const bool is_new = !fs::exists(fs::symlink_status(each.file, ignored));
    const char* const what = each.path.grips ? "closes and opens twice" : "down onto the object, a rest, up";
    if (Status s = save_script(each.path, what, each.file, existing); !s) return take_back(std::move(s));
    if (is_new) added.push_back(each.file);
    for (LevelNode& node : level.nodes)
      if (node.name == each.name && node.device) {
        node.device->driver = DriverKind::kScript;
        node.device->file = each.file.filename().string();
      }
  }
  Status saved = save_level(level, options.out, {0, false, existing});
  return saved ? saved : take_back(std::move(saved));
}

}  // namespace

int author(const AuthorOptions& options) {
  const fs::path out(options.out);
  std::string extension = out.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".glb" && extension != ".gltf")
    return fail(kUsage, {options.out, "a level is glTF", "end the name with .glb or .gltf"});
  Result<Level> level = load_level(options.in);
  if (!level) return fail(kFailed, level.error());
  if (const Status unit = check_unit(*level, options.unit); !unit) return fail(kUsage, unit.error());
  if (const Status unit = check_unit_said(*level, options.unit); !unit) return fail(kFailed, unit.error());
  for (const std::string& sentence : level->notes) note(sentence);
  scale_roots(*level, options.unit.value_or(1.0));
  const bool bare = !level->has_pliant();
  const Box around = bounds(*level);
  if (const std::string hint = unit_hint(around, bare); !hint.empty())
    note(bare ? fmt::format("its diagonal is {:.4g} m, unusual for metres; where it is in millimetres, say --unit mm",
                            around.diagonal())
              : hint);
  Result<Plan> plan = plan_of(options, *level);
  if (!plan) return fail(plan.error().where == options.in ? kFailed : kUsage, plan.error());
  if (plan->probe && !options.probe && options.tool == "none") note("without a tool the level gets a probe");
  const Result<std::vector<Led>> led = author_level(options, *plan, *level);
  if (!led) return fail(kFailed, led.error());
  std::error_code ignored;
  std::vector<fs::path> files{out};
  for (const Led& each : *led) files.push_back(each.file);
  for (const fs::path& file : files)
    if (!options.force && fs::exists(fs::symlink_status(file, ignored)))
      return fail(kFailed, {file.string(), "is there already", "name another, or replace it with --force"});
  const Result<World> world = try_out(*level);
  if (!world) {
    Error error = world.error();
    if (error.where.empty() || error.where == level->path.string()) error.where = options.in;
    if (!plan->soft.empty() && !plan->hand)
      error.cure += std::string(error.cure.empty() ? "" : "; or ") + "try it as a surface: --surface instead of --soft";
    return fail(kFailed, error);
  }
  const Interrupt interrupt({"the level is being written; press Ctrl-C again to quit at once",
                             "quit at once; the level may not be written"});  // all of the files or none
  for (const fs::path& file : files)
    if (const fs::path aside = aside_of(file); !fs::exists(fs::symlink_status(aside, ignored)))
      interrupt.remove_if_forced(aside);
  if (const Status s = write_all(options, *level, *led); !s) return fail(kFailed, s.error());
  print("{}: a level from {}\n", options.out, options.in);
  say_soft(*level, *world, *plan);
  say_rest(*level, *plan, *led);
  print("  the modulus is from: {}\n", plan->preset->source);
  if (const std::string drawn = only_drawn(*level, objects(*level), *world); !drawn.empty()) print("  {}\n", drawn);
  print("  next: pliant run {}\n", options.out);
  return kDone;
}

}  // namespace pliant
