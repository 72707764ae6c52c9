// What a sweep varies: a key of the level or an option of `pliant run`, and the values it takes.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

using PlanJson = nlohmann::ordered_json;  // in the order of the file

struct SweepAxis {
  std::string name;              // NODE.EXT.KEY, or --option
  std::string pointer;           // in the plan
  bool sampled = false;          // of a Latin hypercube: one value a sample, else one value a step
  std::vector<PlanJson> values;  // canonical()
  bool is_option() const { return name.starts_with("--"); }
};

// As a sentence shows what a plan has, which may be long.
std::string brief(const PlanJson& value);
// The value as it stands in an id, a table and on a command line: 300.0 is 300, [1.0, 0] is [1,0].
PlanJson canonical(const PlanJson& value);
std::string text_of(const PlanJson& value);

// A list of values, or {"from", "to", "steps"} with or without "log": true, ends included. `room`: the most values that
// it may have beside the axes before it.
Result<SweepAxis> read_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                            std::size_t room);

// One axis of a Latin hypercube, {"from", "to"} with or without "log": true. Each of `runs` equal parts of the range
// has one sample, somewhere in it. The stream of numbers goes by seed and name, so that the order of the axes means
// nothing, and is the same on every machine.
Result<SweepAxis> read_sampled_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                                    std::size_t runs, std::uint64_t seed);

// "" or what is wrong with an object: a key that is none of `known`.
std::string unknown_in(const PlanJson& object, const std::vector<std::string>& known, const std::string& what);

inline constexpr std::size_t kMostRuns = 100000;  // of a plan: a line of about 1 kB each
inline constexpr std::size_t kMostAxes = 64;      // of a plan
inline constexpr std::size_t kMostValues =
    1000000;                                    // of a plan, runs times axes: some 100 bytes each, and again in lines
inline constexpr std::size_t kMostKeys = 1000;  // of an object in a plan

}  // namespace pliant
