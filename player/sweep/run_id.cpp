#include "player/sweep/run_id.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/gltf/gltf_document.h"
#include "content/keys/extension_table.h"
#include "content/level_file.h"
#include "engine/scene_check.h"
#include "engine/sources.h"
#include "runtime/hash.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSet = "--set=";
constexpr const char* kProbePath = "--probe=";

void add_text(Hash& hash, const std::string& text) {
  hash.add(text.size());
  hash.add_bytes(text.data(), text.size());
}

Status add_file(Hash& hash, const fs::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  hash.add(bytes->size());
  hash.add_bytes(bytes->data(), bytes->size());
  return Done{};
}

// scene_hash() is of keys and positions. Normals make creases; animations, scripts and tetrahedra move or fill what is
// touched: of these the bytes count, wherever a key names a file that is there.
std::string hash_level(const Level& level) {
  Hash hash;
  hash.add(scene_hash(level));
  for (const LevelMesh& mesh : level.meshes)
    for (const PrimitiveAsRead& primitive : fingerprint(mesh).primitives) hash.add(primitive.shape);
  for (const LevelAnimation& animation : level.animations)
    for (const LevelChannel& channel : animation.channels) {
      hash.add(channel.node);
      hash.add(fingerprint(channel, channel.node).track);
    }
  for (const Extension& extension : extension_table()) {
    if (extension.on_scene) continue;  // a panorama is seen, not felt
    for (const LevelNode& node : level.nodes)
      for (const Key& key : extension.keys) {
        if (key.type != KeyType::kText || !extension.present(&node)) continue;
        const Json name = key.get(&node);
        if (!name.is_string() || name.get<std::string>().empty()) continue;
        if (const auto file = confined_file(level.path.parent_path(), name.get<std::string>()))
          if (std::error_code no; fs::is_regular_file(*file, no)) (void)add_file(hash, *file).ok();
      }
  }
  return fmt::format("{:016x}", hash.value());
}

// What settings are tried on: a level without its meshes.
Level keys_of(const Level& level) {
  Level out;
  out.nodes = level.nodes;
  out.environment = level.environment;
  out.simulation = level.simulation;
  out.source = level.source;
  return out;
}

// As `pliant run` would take these arguments; the error is the run's.
Status try_arguments(const Level& level, bool bare, const std::vector<std::string>& arguments) {
  Level tried = level;
  std::vector<ProbeSource> sources;
  std::vector<std::string> sets;
  for (const std::string& argument : arguments) {
    if (argument.starts_with(kSet)) sets.push_back(argument.substr(std::string_view(kSet).size()));
    if (!argument.starts_with(kProbePath)) continue;
    auto source = parse_source(argument.substr(std::string_view(kProbePath).size()));
    if (!source) return source.error();
    if (source->driver == DriverKind::kMouse)
      return Error{argument, "needs a window, and a sweep's runs have none; use orbit or script:FILE.csv"};
    sources.push_back(*source);
  }
  if (bare && sources.empty()) sources.push_back({"probe", DriverKind::kOrbit, {}});
  if (const Status ok = add_probes(tried, sources); !ok) return ok;
  return set_keys(tried, sets);
}

// What is wrong with the plan's own settings, then with a value of an axis: where it fits no run, neither beside the
// first values of the other axes nor beside the last nor alone.
Status try_values(const SweepPlan& plan, const Level& level, bool bare) {
  const auto wrong = [&](const std::vector<PlanJson>& values) {
    return try_arguments(level, bare, arguments_of(plan, values));
  };
  const auto begin = plan.values_of(0), end = plan.values_of(plan.count() - 1);
  const std::vector<PlanJson> none;
  const std::string file = plan.file.string() + " ";
  const Status alone = wrong(none);
  if (!alone && !wrong(begin) && !wrong(end)) return Error{file + "/options", alone.error().message()};
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    SweepPlan only = plan;
    only.axes = {axis};
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      auto first = begin, last = end;
      first[a] = last[a] = axis.values[i];
      if (wrong(first) || wrong(last)) continue;
      const Status ok = try_arguments(level, bare, arguments_of(only, {axis.values[i]}));
      if (ok) continue;
      const bool list = !axis.sampled;
      return Error{file + axis.pointer + (list ? "/" + std::to_string(i) : ""), ok.error().message()};
    }
  }
  return Done{};
}

// The limit that the plan gives its runs holds for the level that it is tried on; then what it was.
class LimitFactor {
 public:
  explicit LimitFactor(const SweepPlan& plan) : before_(limit_factor()) {
    for (const auto& [name, value] : plan.options)
      if (name == "--limits") set_limit_factor(std::stod(value));
  }
  ~LimitFactor() { set_limit_factor(before_); }
  LimitFactor(const LimitFactor&) = delete;
  LimitFactor& operator=(const LimitFactor&) = delete;

 private:
  double before_;
};

}  // namespace

Result<ExpandedPlan> expand_plan(const SweepPlan& plan) {
  const LimitFactor limits(plan);
  auto loaded = load_level(plan.level);
  if (!loaded) return loaded.error();
  Level& level = *loaded;
  const bool bare = !level.has_pliant();
  if (bare) make_touchable(level);
  ExpandedPlan out;
  out.level_name = level.name;
  out.level_hash = hash_level(level);
  const Level keys = keys_of(level);
  if (Status ok = try_values(plan, keys, bare); !ok) return ok.error();

  std::vector<std::pair<std::string, std::uint64_t>> files;  // named by arguments, each read once
  for (std::size_t i = 0; i < plan.count(); ++i) {
    SweepRun& run = out.runs.emplace_back();
    run.values = plan.values_of(i);
    run.arguments = arguments_of(plan, run.values);
    Hash hash;
    add_text(hash, PLIANT_VERSION);
    add_text(hash, out.level_hash);
    for (const std::string& argument : run.arguments) {
      if (argument.starts_with("--threads=")) continue;  // results do not depend on it
      add_text(hash, argument);
      const fs::path file = file_of(plan, argument);
      if (file.empty()) continue;
      auto known = std::find_if(files.begin(), files.end(), [&](const auto& each) { return each.first == argument; });
      if (known == files.end()) {
        Hash bytes;
        if (Status ok = add_file(bytes, file); !ok)
          return Error{plan.file.string(), argument + ": " + ok.error().message()};
        known = files.insert(files.end(), {argument, bytes.value()});
      }
      hash.add(known->second);
    }
    run.id = fmt::format("{:016x}", hash.value());
  }
  return out;
}

}  // namespace pliant
