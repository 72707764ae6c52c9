#include "lab/sweep/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "content/files/file_io.h"
#include "content/gltf/form/gltf_document.h"
#include "content/keys/extension_table.h"
#include "engine/run/sources.h"
#include "lab/files/content_folder.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr Limit kPlanFile{16 * limits::kMiB, "bytes", "a plan is held in memory"};
constexpr int kDeepestNesting = 16;  // a valid plan is nested at most 5 deep

// Options of `pliant run` that the sweep sets itself, with the reason.
struct RefusedOption {
  const char *name, *why, *cure;
};
constexpr RefusedOption kRefused[] = {
    {"--out", "is the sweep's own", "runs write into a folder that goes again"},
    {"--force", "replaces results, and a run of a sweep has a folder of its own", "leave it out"},
    {"--window", "opens a window, and a sweep's runs have none", "leave it out"},
    {"--headless", "holds for every run of a sweep", "leave it out"},
    {"--input", "needs a window, and a sweep's runs have none", "leave it out"},
    {"--realtime", "is not the same twice, and a sweep's runs are in lockstep", "leave it out"},
    {"--lockstep", "holds for every run of a sweep", "leave it out"},
    {"--record", "writes a file that the next run would replace", "record one run with `pliant run`"},
    {"--list", "runs nothing", "leave it out"},
    {"--help", "runs nothing", "leave it out"},
    {"--frames", "takes pictures, and a sweep's runs take none", "leave it out"},
    {"--fps", "takes pictures, and a sweep's runs take none", "leave it out"},
    {"--size", "is of pictures, and a sweep's runs take none", "leave it out"},
    {"--soft-store", "is the sweep's own", "leave it out"},
    {"--field", "is of pictures, and a sweep's runs take none: forces come from the CPU", "leave it out"}};

std::string argument(const std::string& name, const PlanJson& value) {
  return value.is_boolean() ? name : name + "=" + text_of(value);
}

// Empty, or the error of `pliant run` for this option.
Status check_option(CheckArguments check, const std::string& name, const PlanJson& value) {
  // A value in the name would bypass the list of refused options.
  if (name.find('=') != std::string::npos || name == "--")
    return Error{"", "'" + name + "' is no name of an option", "write the name alone, and its value behind the colon"};
  for (const auto& [refused, why, cure] : kRefused)
    if (name == refused) return Error{"", std::string("the option ") + refused + " " + why, cure};
  if (value.is_object() || value.is_array() || value.is_null())
    return Error{"", "must be a number, a text, true or false; got " + brief(value)};
  return check({argument(name, value)});
}

Error syntax_error(const fs::path& file, const std::string& text, std::size_t byte) {
  const std::size_t end = std::min(byte ? byte - 1 : 0, text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const std::size_t start = end ? text.rfind('\n', end - 1) : std::string::npos;
  return {file.string(),
          fmt::format("is no JSON at line {}, column {}", line, end - (start == std::string::npos ? 0 : start + 1) + 1),
          "check brackets, commas and quotes there"};
}

Result<PlanJson> parse(const fs::path& file) {
  auto bytes = read_file(file, kPlanFile);
  if (!bytes) return bytes.error();
  const std::string text(bytes->begin(), bytes->end());
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  std::string twice;
  bool deep = false, wide = false;
  const auto look = [&](int depth, PlanJson::parse_event_t event, PlanJson& parsed) {
    if (depth > kDeepestNesting) deep = true;
    if (event == PlanJson::parse_event_t::object_start) keys.emplace_back();
    if (event == PlanJson::parse_event_t::object_end && !keys.empty()) keys.pop_back();
    if (event == PlanJson::parse_event_t::key && !keys.empty() && !keys.back().insert(parsed.get<std::string>()).second)
      twice = parsed.get<std::string>();
    wide = wide || (!keys.empty() && keys.back().size() > kMostKeys);
    return !deep && !wide;  // skipped values are not stored
  };
  try {
    PlanJson json = PlanJson::parse(text, look);
    if (deep) return Error{file.string(), "is nested deeper than any plan", "see docs/sweep.md"};
    if (wide)
      return Error{file.string(), fmt::format("has an object with more than {} keys", kMostKeys), "see docs/sweep.md"};
    if (!twice.empty())
      return Error{file.string(), fmt::format("has the key \"{}\" twice in one object", twice),
                   "leave one of them out"};
    if (!json.is_object())
      return Error{file.string(), "is no JSON object", "give it \"level\" and \"axes\" (docs/sweep.md)"};
    return json;
  } catch (const PlanJson::parse_error& error) {
    return syntax_error(file, text, error.byte);
  } catch (const PlanJson::out_of_range& error) {
    // The library's message ends with the number in quotes.
    const std::string said = error.what();
    const std::size_t quote = said.find('\'');
    return Error{file.string(),
                 "has a number that no computer's number holds" +
                     (quote == std::string::npos ? "" : ": " + said.substr(quote, 40)),
                 "write one below 1e308"};
  }
}

// Reads the parts of one plan, in turn, into `plan`. Errors contain the JSON pointer; the caller prepends the file.
class Reader {
 public:
  Reader(const PlanJson& json, SweepPlan& plan, CheckArguments check) : json_(json), plan_(plan), check_(check) {}

  Status read() {
    if (const auto wrong =
            unknown_in(json_, {"level", "options", "axes", "latin_hypercube", "timeout_s", "keep", "about"}, "a plan"))
      return error_at("", *wrong);
    for (const auto part :
         {&Reader::level, &Reader::options, &Reader::axes, &Reader::hypercube, &Reader::timeout, &Reader::keep})
      if (Status ok = (this->*part)(); !ok) return ok;
    if (plan_.axes.empty())
      return Error{"", "varies nothing", "give \"axes\" or \"latin_hypercube\", or use `pliant run`"};
    return Done{};
  }

 private:
  Status level() {
    if (!json_.contains("level")) return Error{"", "has no \"level\"", "name a file or a shipped level"};
    if (!json_["level"].is_string()) return Error{"/level", "must be a text; got " + brief(json_["level"])};
    const auto name = json_["level"].get<std::string>();
    if (name.empty()) return Error{"/level", "its name is empty", "name a file or a shipped level"};
    std::error_code no;
    if (const fs::path beside = plan_.file.parent_path() / name; fs::is_regular_file(beside, no)) {
      plan_.level = beside;
      return Done{};
    }
    auto found = find_level(name);
    if (!found) return Error{"/level", found.error().message()};
    plan_.level = *found;
    return Done{};
  }

  Status options() {
    if (!json_.contains("options")) return Done{};
    const PlanJson& options = json_["options"];
    if (!options.is_object()) return Error{"/options", "must be an object of options; got " + brief(options)};
    for (const auto& [key, value] : options.items()) {
      const std::string name = "--" + key, at = "/options/" + escaped(key);
      const bool many = name == "--set" || name == "--probe";
      if (many && value.size() > kMostKeys)
        return Error{at, fmt::format("has more than {} texts", kMostKeys), "leave some out"};
      if (many && !value.is_array()) return Error{at, "must be a list of texts; got " + brief(value)};
      for (std::size_t i = 0; i < (many ? value.size() : 1); ++i) {
        const PlanJson& one = many ? value[i] : value;
        const std::string where = many ? at + "/" + std::to_string(i) : at;
        if (many && !one.is_string()) return Error{where, "must be a text; got " + brief(one)};
        if (const Status fine = check_option(check_, name, one); !fine) return fine.error().at(where);
        if (one.is_boolean() && !one.get<bool>()) continue;
        plan_.options.emplace_back(name, one.is_boolean() ? "" : text_of(one));
      }
    }
    std::stable_sort(plan_.options.begin(), plan_.options.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return Done{};
  }

  // Duplicates are rejected: which one counts would be arbitrary.
  Status check_name(const std::string& name, const std::string& pointer) {
    for (const SweepAxis& axis : plan_.axes)
      if (axis.name == name)
        return Error{pointer, "`" + name + "` is an axis already (" + axis.pointer + ")", "leave one of them out"};
    for (const auto& [option, value] : plan_.options)
      if (option == name && name != "--probe")
        return Error{pointer, "`" + name + "` stands in /options too", "leave it out there"};
    if (name == "--set") return Error{pointer, "is no axis", "name the key itself: NODE.EXTENSION.KEY"};
    if (name == "--threads")
      return Error{pointer, "is no axis: it changes no result, so that its runs are one", "give it in \"options\""};
    if (name.find('=') != std::string::npos)
      return Error{pointer, "has '=' in its name", "write the name alone, and its values behind the colon"};
    return Done{};
  }

  // Checked before the values are created.
  Status check_count(const std::string& pointer, std::size_t more_axes, std::size_t times) {
    const std::size_t axes = plan_.axes.size() + more_axes, runs = plan_.count() * times;
    if (axes > kMostAxes)
      return Error{pointer, fmt::format("makes {} axes, and a plan has at most {}", axes, kMostAxes),
                   "leave some out, or make several plans"};
    if (runs > kMostRuns)
      return Error{pointer, fmt::format("makes more than {} runs of the plan", kMostRuns),
                   "take fewer values, or fewer samples"};
    if (axes * runs > kMostValues)
      return Error{pointer,
                   fmt::format("makes {} runs of {} axes, more than {} values in all", runs, axes, kMostValues),
                   "take fewer of either"};
    return Done{};
  }

  Status add(Result<SweepAxis> axis) {
    if (!axis) return axis.error();
    for (std::size_t i = 0; axis->is_option() && i < axis->values.size(); ++i)
      if (const Status fine = check_option(check_, axis->name, axis->values[i]); !fine)
        return fine.error().at(axis->pointer + (axis->sampled ? "" : "/" + std::to_string(i)));
    plan_.axes.push_back(std::move(axis).value());
    return Done{};
  }

  Status axes() {
    if (!json_.contains("axes")) return Done{};
    const PlanJson& axes = json_["axes"];
    if (!axes.is_object()) return Error{"/axes", "must be an object of axes; got " + brief(axes)};
    if (Status ok = check_count("/axes", axes.size(), 1); !ok) return ok;
    for (const auto& [name, values] : axes.items()) {
      const std::string at = "/axes/" + escaped(name);
      if (Status ok = check_name(name, at); !ok) return ok;
      if (Status ok = add(read_axis(name, values, at, kMostRuns / plan_.count())); !ok) return ok;
      if (Status ok = check_count(at, 0, 1); !ok) return ok;
    }
    return Done{};
  }

  Result<std::uint64_t> whole(const PlanJson& object, const std::string& key, double low, double high) {
    const std::string at = "/latin_hypercube/" + key;
    if (!object.contains(key)) return Error{"/latin_hypercube", "has no \"" + key + "\"", "give it a whole number"};
    const PlanJson value = canonical(object[key]);
    if (!value.is_number_integer() || value.get<double>() < low || value.get<double>() > high)
      return Error{at, fmt::format("must be a whole number between {} and {}; got {}", low, high, brief(object[key]))};
    return value.get<std::uint64_t>();
  }

  Status hypercube() {
    if (!json_.contains("latin_hypercube")) return Done{};
    const PlanJson& cube = json_["latin_hypercube"];
    const std::string at = "/latin_hypercube";
    if (!cube.is_object())
      return Error{at, "must be an object with \"runs\", \"seed\" and \"axes\"; got " + brief(cube)};
    if (const auto wrong = unknown_in(cube, {"runs", "seed", "axes"}, "latin_hypercube")) return error_at(at, *wrong);
    const auto runs = whole(cube, "runs", 2, kMostRuns), seed = whole(cube, "seed", 0, 0x1p53);
    if (!runs) return runs.error();
    if (!seed) return seed.error();
    if (!cube.contains("axes") || !cube["axes"].is_object() || cube["axes"].empty())
      return Error{at, "has no \"axes\"", "name keys or options, each with {\"from\", \"to\"}"};
    if (Status ok = check_count(at, cube["axes"].size(), *runs); !ok) return ok;
    plan_.samples = *runs;
    for (const auto& [name, range] : cube["axes"].items()) {
      const std::string pointer = at + "/axes/" + escaped(name);
      if (Status ok = check_name(name, pointer); !ok) return ok;
      if (Status ok = add(read_sampled_axis(name, range, pointer, *runs, *seed)); !ok) return ok;
    }
    return Done{};
  }

  Status timeout() {
    if (!json_.contains("timeout_s")) return Done{};
    const PlanJson& value = json_["timeout_s"];
    if (!value.is_number() || !(value.get<double>() >= 1e-3 && value.get<double>() <= 1e7))
      return Error{"/timeout_s", "must be between 0.001 and 1e7 s; got " + brief(value)};
    plan_.timeout = value.get<double>();
    return Done{};
  }

  // A text or a list of texts, so that more kinds can be added.
  Status keep() {
    if (!json_.contains("keep")) return Done{};
    const PlanJson& keep = json_["keep"];
    const PlanJson all = keep.is_array() ? keep : PlanJson::array({keep});
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i] != "curves")
        return Error{keep.is_array() ? "/keep/" + std::to_string(i) : "/keep",
                     "must be \"curves\" (forces over time of every run); got " + brief(all[i])};
      plan_.keep_curves = true;
    }
    return Done{};
  }

  const PlanJson& json_;
  SweepPlan& plan_;
  CheckArguments check_;
};

}  // namespace

std::size_t SweepPlan::count() const {
  std::size_t runs = samples;
  for (const SweepAxis& axis : axes)
    if (!axis.sampled) runs *= axis.values.size();
  return runs;
}

std::vector<PlanJson> SweepPlan::values_of(std::size_t run) const {
  std::vector<PlanJson> values(axes.size());
  const std::size_t sample = run % samples;
  std::size_t step = run / samples;
  for (std::size_t i = axes.size(); i-- > 0;) {
    const std::vector<PlanJson>& all = axes[i].values;
    values[i] = axes[i].sampled ? all[sample] : all[step % all.size()];
    if (!axes[i].sampled) step /= all.size();
  }
  return values;
}

std::vector<std::string> arguments_of(const SweepPlan& plan, const std::vector<PlanJson>& values) {
  std::vector<std::string> options, sets;
  for (const auto& [name, value] : plan.options)
    (name == "--set" ? sets : options).push_back(value.empty() ? name : name + "=" + value);
  std::vector<std::string> added, all_nodes, nodes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SweepAxis& axis = plan.axes[i];
    if (!axis.is_option())
      (axis.name.starts_with("*.") ? all_nodes : nodes).push_back("--set=" + axis.name + "=" + text_of(values[i]));
    else if (!values[i].is_boolean() || values[i].get<bool>())
      added.push_back(argument(axis.name, values[i]));
  }
  for (std::vector<std::string>* each : {&added, &all_nodes, &nodes}) std::sort(each->begin(), each->end());
  for (const std::vector<std::string>* each : {&added, &sets, &all_nodes, &nodes})
    options.insert(options.end(), each->begin(), each->end());
  return options;
}

ArgumentFile file_in(const SweepPlan& plan, const std::string& argument) {
  constexpr std::string_view kReplay = "--replay=", kProbe = "--probe=", kScript = "script:", kHand = "hand:";
  const auto at = [&](std::size_t begin, std::size_t size) {
    return ArgumentFile{plan.file.parent_path() / argument.substr(begin, size), begin, size};
  };
  if (argument.starts_with(kReplay)) return at(kReplay.size(), std::string::npos);
  if (!argument.starts_with(kProbe)) return {};
  const auto source = parse_source(argument.substr(kProbe.size()));
  if (!source || source->file.empty()) return {};
  std::size_t begin = kProbe.size() + source->name.size() + 1;
  if (!source->held) return at(begin + kScript.size(), std::string::npos);
  // One of the hand's comma-separated words, with optional blanks.
  begin += kHand.size();
  for (std::size_t found = argument.find(source->file, begin); found != std::string::npos;
       found = argument.find(source->file, found + 1)) {
    const std::size_t end = found + source->file.size(), before = argument.find_last_not_of(" \t", found - 1),
                      after = argument.find_first_not_of(" \t", end);
    if ((before < begin || argument[before] == ',') &&
        (after == std::string::npos || argument[after] == ',' || argument[after] == '|'))
      return at(found, source->file.size());
  }
  return {};
}

Result<SweepPlan> read_plan(const fs::path& file, CheckArguments check) {
  SweepPlan plan;
  plan.file = file;
  auto json = parse(file);
  if (!json) return json.error();
  if (const Status ok = Reader(*json, plan, check).read(); !ok) {
    const std::string& pointer = ok.error().where;
    return ok.error().at(file.string() + (pointer.empty() ? "" : " " + pointer));
  }
  return plan;
}

}  // namespace pliant
