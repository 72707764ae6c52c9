#include "lab/sweep/run_id.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "content/files/file_io.h"
#include "content/keys/extension_table.h"
#include "content/level_file.h"
#include "engine/run/scene_hash.h"
#include "engine/run/sources.h"
#include "pliant/content.h"
#include "runtime/hash.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSet = "--set=";
constexpr const char* kProbePath = "--probe=";

Status add_file(Hash& hash, const fs::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  hash.add(bytes->size());
  hash.add_bytes(bytes->data(), bytes->size());
  return Done{};
}

// scene_hash() and the other inputs of a run: device scripts, error budgets, and the keys that are excluded from the
// choice of models because the level sets them.
std::string hash_level(const Level& level) {
  Hash hash;
  hash.add(scene_hash(level));
  const auto add_stated = [&](const std::set<std::string>& keys) {
    hash.add(keys.size());
    for (const std::string& key : keys) add_text(hash, key);
  };
  add_stated(level.stated);
  for (const LevelNode& node : level.nodes) {
    add_stated(node.stated);
    hash.add(node.deformable ? node.deformable->error : 0.0);
    hash.add(node.soft_body ? node.soft_body->error : 0.0);
    if (node.device) add_named_file(hash, level.path.parent_path(), node.device->file);
  }
  return fmt::format("{:016x}", hash.value());
}

// Hashes of files that arguments name; each file is read once.
class FileHashes {
 public:
  FileHashes(const SweepPlan& plan, const Level& level) : plan_(plan), folder_(level.path.parent_path()) {}

  // Adds an argument to an id: for a file its contents, not its location.
  Status add(Hash& hash, const std::string& argument) {
    const ArgumentFile file = file_in(plan_, argument);
    if (!file.path.empty()) {
      auto known = read_.find(file.path.string());
      if (known == read_.end()) {
        Hash bytes;
        if (Status ok = add_file(bytes, file.path); !ok)
          return Error{plan_.file.string(), argument + ": " + ok.error().message()};
        known = read_.emplace(file.path.string(), bytes.value()).first;
      }
      add_text(hash, std::string(argument).replace(file.begin, file.size, ""));
      hash.add(known->second);
      return Done{};
    }
    add_text(hash, argument);
    if (argument.starts_with(kSet)) add_setting(hash, argument.substr(std::string_view(kSet).size()));
    return Done{};
  }

 private:
  // NODE.EXT.KEY=VALUE; the value may be a file beside the level.
  void add_setting(Hash& hash, const std::string& setting) {
    const std::size_t equals = setting.find('=');
    const Key* key = equals == std::string::npos ? nullptr : find_key_of_path(setting.substr(0, equals));
    if (!key || key->type != KeyType::kText) return;
    const std::string name = setting.substr(equals + 1);
    auto known = named_.find(name);
    if (known == named_.end()) {
      Hash bytes;
      add_named_file(bytes, folder_, name);
      known = named_.emplace(name, bytes.value()).first;
    }
    hash.add(known->second);
  }

  const SweepPlan& plan_;
  fs::path folder_;                             // of the level
  std::map<std::string, std::uint64_t> read_;   // by path, for options
  std::map<std::string, std::uint64_t> named_;  // by value, for keys
};

// A level without its meshes, on which settings are checked.
Level keys_of(const Level& level) {
  Level out;
  out.nodes = level.nodes;
  out.environment = level.environment;
  out.simulation = level.simulation;
  out.stated = level.stated;
  out.source = level.source;
  return out;
}

// Checks these arguments as `pliant run` does; the error is the same.
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
      return Error{argument, "needs a window, and a sweep's runs have none", "use orbit or script:FILE.csv"};
    if (!source->device.empty())
      return Error{argument, "is moved by a hand, never the same twice",
                   "record it with `pliant run --record FILE`, and give the option \"replay\""};
    sources.push_back(*source);
  }
  if (bare && sources.empty()) sources.push_back({"probe", DriverKind::kOrbit, {}});
  if (const Status ok = add_probes(tried, sources); !ok) return ok;
  return set_keys(tried, sets);
}

// Reports an error in the plan's own settings, then an axis value that is valid in no run: neither with the first
// values of the other axes, nor with the last, nor alone.
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

// Applies the plan's limit factor while its level is checked, then restores the previous one.
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

  FileHashes files(plan, level);
  for (std::size_t i = 0; i < plan.count(); ++i) {
    SweepRun& run = out.runs.emplace_back();
    run.values = plan.values_of(i);
    run.arguments = arguments_of(plan, run.values);
    Hash hash;
    add_text(hash, PLIANT_VERSION);
    add_text(hash, out.level_hash);
    for (const std::string& argument : run.arguments) {
      if (argument.starts_with("--threads=")) continue;  // results do not depend on it
      if (Status ok = files.add(hash, argument); !ok) return ok.error();
    }
    run.id = fmt::format("{:016x}", hash.value());
  }
  return out;
}

}  // namespace pliant
