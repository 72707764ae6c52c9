// A path that is edited as a curve: a few keys over a surface, and the script that they make.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "components/math.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

struct PathKey {
  double time = 0.0;    // [s] ascending
  dvec3 anchor{0};      // [m] world; of a key on a surface, the place there
  dvec3 normal{0};      // [1] world, outward; 0: the key is in the air, at `anchor`
  double height = 0.0;  // [m] of the tip's surface over it, along the normal; < 0: pressed in as deep
  dvec3 position() const { return anchor + height * normal; }
  bool operator==(const PathKey&) const = default;
};

// The sphere at the tip of the probe or tool that is led.
struct PathTip {
  dvec3 place{0};            // [m] device frame: its middle
  double radius = 0.0;       // [m]
  dvec3 axis{0};             // [1] device frame: from what is touched up the shaft, along the normal; 0: nothing turns
  dquat stands{1, 0, 0, 0};  // to world: how it stands before it is turned
  bool operator==(const PathTip&) const = default;
};

struct ScriptKeys {
  std::vector<PathKey> keys;
  bool smooth = true;  // once continuously differentiable through the keys, without passing beyond them; else straight
  bool repeats = false;
  bool along = false;  // between keys on a surface the tip follows it, at the height that comes between theirs
  PathTip tip;
  // What the device does, where the keys alone do not say it: made with the surfaces (surface_path.h), or as the file
  // has it. Null: straight from key to key, or the monotone cubic.
  std::shared_ptr<const std::vector<PathRow>> rows;
  bool operator==(const ScriptKeys& other) const;
};

inline constexpr double kScriptStep = 0.01;  // [s] between rows of the script of a smooth path

// Monotone cubic Hermite through the keys, each coordinate for itself (Fritsch and Carlson 1980): no coordinate leaves
// the range of the two keys around it, so that a press goes no deeper than its keys say.
// Of the tip's lowest point, [m] world.
dvec3 position_at(const ScriptKeys& script, double time);
// Heights alone, [m].
double height_at(const ScriptKeys& script, double time);
// Where the device is, and how it is turned.
PathRow pose_at(const ScriptKeys& script, double time);
Path path_of(const ScriptKeys& script);
// The keys of a path within `tolerance` [m] of it (Ramer, Douglas and Peucker, in space and time).
ScriptKeys keys_of(const Path& path, double tolerance);
// As few keys as a smooth path needs that is nowhere farther than `tolerance` [m] from the rows.
ScriptKeys smooth_keys_of(const Path& path, double tolerance);

// As a script file that every run reads; the keys stand in its comments, so that they come back as they were. It has
// been read back: what no run would read is an error.
Result<std::string> text_of_keys(const ScriptKeys& script, const std::string& name);
Status save_keys(const ScriptKeys& script, const std::filesystem::path& file);
Result<ScriptKeys> load_keys(const std::filesystem::path& file);

}  // namespace pliant
