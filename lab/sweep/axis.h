// An axis of a sweep: a key of the level or an option of `pliant run`, and its values.
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
  bool sampled = false;          // of a Latin hypercube: one value per sample; else one value per step
  std::vector<PlanJson> values;  // canonical()
  bool is_option() const { return name.starts_with("--"); }
};

// A value of a plan shortened for a sentence.
std::string brief(const PlanJson& value);
// Canonical form of a value for an id, a table and a command line: 300.0 is 300, [1.0, 0] is [1,0].
PlanJson canonical(const PlanJson& value);
std::string text_of(const PlanJson& value);

// A list of values, or {"from", "to", "steps"} with or without "log": true, ends included. `room`: most values allowed,
// given the axes before it.
Result<SweepAxis> read_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                            std::size_t room);

// One axis of a Latin hypercube, {"from", "to"} with or without "log": true. Each of `runs` equal parts of the range
// has one random sample. The random stream depends on seed and name only: the order of the axes does not matter, and
// the samples are the same on every machine.
Result<SweepAxis> read_sampled_axis(const std::string& name, const PlanJson& json, const std::string& pointer,
                                    std::size_t runs, std::uint64_t seed);

// Empty, or a sentence that names a key of the object which is not in `known`.
std::optional<Note> unknown_in(const PlanJson& object, const std::vector<std::string>& known, const std::string& what);

inline constexpr std::size_t kMostRuns = 100000;  // per plan: a line of about 1 kB each
inline constexpr std::size_t kMostAxes = 64;      // per plan
inline constexpr std::size_t kMostValues =
    1000000;                                    // per plan, runs times axes: some 100 bytes each, and again in lines
inline constexpr std::size_t kMostKeys = 1000;  // per object in a plan

}  // namespace pliant
