#include "lab/sweep/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "content/keys/extension_table.h"
#include "runtime/hash.h"

namespace pliant {
namespace {

// Splitmix64 (Steele, Lea & Flood, OOPSLA 2014). The distributions of the standard library differ between
// implementations.
class Stream {
 public:
  Stream(std::uint64_t seed, const std::string& name) {
    Hash hash;
    hash.add(seed);
    hash.add_bytes(name.data(), name.size());
    state_ = hash.value();
  }
  std::uint64_t next() {
    std::uint64_t x = state_ += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // [0, 1)
  // Uniform below n; biased values are drawn again.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t unfair = (0 - n) % n;
    for (;;)
      if (const std::uint64_t x = next(); x >= unfair) return x % n;
  }

 private:
  std::uint64_t state_ = 0;
};

// Twelve digits: exp and log may differ between machines in the last of sixteen digits, and the ids would differ too.
double rounded(double value) {
  return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
}

struct Span {
  double from = 0.0, to = 0.0;
  bool log = false;
  double at(double share) const {
    if (share <= 0.0) return from;
    if (share >= 1.0) return to;
    const double value =
        log ? std::exp(std::log(from) + (std::log(to) - std::log(from)) * share) : from + (to - from) * share;
    return rounded(value);
  }
};

Result<Span> read_span(const PlanJson& json, const std::string& pointer) {
  Span span;
  for (const auto& [key, end] : {std::pair("from", &span.from), {"to", &span.to}}) {
    if (!json.contains(key)) return Error{pointer, fmt::format("has no \"{}\"", key), "give the range both ends"};
    const PlanJson& value = json[key];
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      return Error{pointer + "/" + key, "must be a number; got " + brief(value)};
    *end = value.get<double>();
  }
  if (!(span.from < span.to))
    return Error{pointer, fmt::format("goes from {} to {}", span.from, span.to), "\"from\" must be less than \"to\""};
  if (json.contains("log")) {
    if (!json["log"].is_boolean()) return Error{pointer + "/log", "must be true or false; got " + brief(json["log"])};
    span.log = json["log"].get<bool>();
  }
  if (span.log && !(span.from > 0.0))
    return Error{pointer + "/from", fmt::format("must be above 0 where \"log\" is true; got {}", span.from)};
  return span;
}

Error too_many(const std::string& pointer) {
  return {pointer, fmt::format("makes more than {} runs of the plan, with the axes before it", kMostRuns),
          "take fewer values, or a Latin hypercube"};
}

Result<SweepAxis> read_list(SweepAxis axis, const PlanJson& json, std::size_t room) {
  if (json.empty()) return Error{axis.pointer, "is an empty list", "give it values, or leave the axis out"};
  if (json.size() > room) return too_many(axis.pointer);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string at = axis.pointer + "/" + std::to_string(i);
    if (json[i].is_null() || json[i].is_object())
      return Error{at, "must be a number, a text, true, false or a list of numbers; got " + brief(json[i])};
    axis.values.push_back(canonical(json[i]));
    if (!seen.insert(text_of(axis.values.back())).second)
      return Error{at, "the value " + brief(json[i]) + " stands twice", "leave one of them out"};
  }
  return axis;
}

}  // namespace

PlanJson canonical(const PlanJson& value) {
  if (value.is_array()) {
    PlanJson list = PlanJson::array();
    for (const PlanJson& each : value) list.push_back(canonical(each));
    return list;
  }
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (number == std::floor(number) && std::abs(number) < 0x1p53) return static_cast<std::int64_t>(number);
  }
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= INT64_MAX) return value.get<std::int64_t>();
  return value;
}

std::string brief(const PlanJson& value) {
  constexpr std::size_t kLongest = 80;  // [byte]
  // Large values are not formatted beyond what is shown.
  if (value.is_structured() && value.size() > kLongest) return value.is_array() ? "a long list" : "a large object";
  std::string text = value.dump(-1, ' ', true, PlanJson::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string text_of(const PlanJson& value) {
  return value.is_string() ? value.get<std::string>()
                           : canonical(value).dump(-1, ' ', false, PlanJson::error_handler_t::replace);
}

std::optional<Note> unknown_in(const PlanJson& object, const std::vector<std::string>& known, const std::string& what) {
  for (const auto& [key, value] : object.items())
    if (std::find(known.begin(), known.end(), key) == known.end()) return unknown("key", key, what, "keys", known);
  return std::nullopt;
}

Result<SweepAxis> read_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                            std::size_t room) {
  SweepAxis axis{name, pointer, false, {}};
  if (json.is_array()) return read_list(std::move(axis), json, room);
  if (!json.is_object())
    return Error{pointer, "must be a list of values or {\"from\", \"to\", \"steps\"}; got " + brief(json)};
  if (const auto wrong = unknown_in(json, {"from", "to", "steps", "log"}, "a range")) return error_at(pointer, *wrong);
  auto span = read_span(json, pointer);
  if (!span) return span.error();
  if (!json.contains("steps")) return Error{pointer, "has no \"steps\"", "say how many values the range has"};
  const PlanJson steps = canonical(json["steps"]);
  if (!steps.is_number_integer() || steps.get<double>() < 2 || steps.get<double>() > kMostRuns)
    return Error{pointer + "/steps",
                 fmt::format("must be a whole number between 2 and {}; got {}", kMostRuns, brief(json["steps"]))};
  const auto count = steps.get<std::size_t>();
  if (count > room) return too_many(pointer);
  std::set<double> seen;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = span->at(static_cast<double>(i) / static_cast<double>(count - 1));
    if (!seen.insert(value).second)
      return Error{
          pointer + "/steps",
          fmt::format("{} values are too many for twelve digits between {} and {}", count, span->from, span->to),
          "take fewer, or a wider range"};
    axis.values.push_back(canonical(value));
  }
  return axis;
}

Result<SweepAxis> read_sampled_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                                    std::size_t runs, std::uint64_t seed) {
  SweepAxis axis{name, pointer, true, {}};
  if (!json.is_object()) return Error{pointer, "must be {\"from\", \"to\"}; got " + brief(json)};
  if (const auto wrong = unknown_in(json, {"from", "to", "log"}, "a range")) return error_at(pointer, *wrong);
  auto span = read_span(json, pointer);
  if (!span) return span.error();
  Stream stream(seed, name);
  std::vector<std::size_t> part(runs);
  for (std::size_t i = 0; i < runs; ++i) part[i] = i;
  for (std::size_t i = runs; i > 1; --i) std::swap(part[i - 1], part[stream.below(i)]);
  for (const std::size_t p : part) {
    const double share = (static_cast<double>(p) + stream.unit()) / static_cast<double>(runs);
    axis.values.push_back(canonical(span->at(share)));
  }
  return axis;
}

}  // namespace pliant
