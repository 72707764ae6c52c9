// A path edited as a curve: a few keys over a surface, and the resulting script.
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
  dvec3 anchor{0};      // [m] world; for a key on a surface, the point there
  dvec3 normal{0};      // [1] world, outward; 0: the key is in the air, at `anchor`
  double height = 0.0;  // [m] of the tip's surface above the anchor, along the normal; < 0: pressed in
  dvec3 position() const { return anchor + height * normal; }
  bool operator==(const PathKey&) const = default;
};

// The sphere at the tip of the moved probe or tool.
struct PathTip {
  dvec3 place{0};            // [m] device frame: its centre
  double radius = 0.0;       // [m]
  dvec3 axis{0};             // [1] device frame: from the tip up the shaft, aligned with the normal; 0: no rotation
  dquat stands{1, 0, 0, 0};  // to world: its initial rotation
  bool operator==(const PathTip&) const = default;
};

struct ScriptKeys {
  std::vector<PathKey> keys;
  bool smooth = true;  // C1 through the keys, without overshoot; else straight
  bool repeats = false;
  bool along = false;  // between keys on a surface the tip follows it, at the interpolated height
  PathTip tip;
  // The device's motion, if the keys alone do not define it: computed with the surfaces (surface_path.h), or read from
  // the file. Null: straight from key to key, or the monotone cubic.
  std::shared_ptr<const std::vector<PathRow>> rows;
  bool operator==(const ScriptKeys& other) const;
};

inline constexpr double kScriptStep = 0.01;  // [s] between rows of the script of a smooth path

// Monotone cubic Hermite through the keys, per coordinate (Fritsch and Carlson 1980). No coordinate leaves the range of
// its two neighbouring keys, so a press is no deeper than its keys. Of the tip's lowest point, [m] world.
dvec3 position_at(const ScriptKeys& script, double time);
// Heights alone, [m].
double height_at(const ScriptKeys& script, double time);
// Pose of the device.
PathRow pose_at(const ScriptKeys& script, double time);
Path path_of(const ScriptKeys& script);
// The keys of a path within `tolerance` [m] of it (Ramer, Douglas and Peucker, in space and time).
ScriptKeys keys_of(const Path& path, double tolerance);
// The fewest keys for a smooth path that stays within `tolerance` [m] of the rows.
ScriptKeys smooth_keys_of(const Path& path, double tolerance);

// As a script file that every run can read; the keys are in its comments, so that they are restored exactly. The text
// is read back: a text that a run could not read is an error.
Result<std::string> text_of_keys(const ScriptKeys& script, const std::string& name);
Status save_keys(const ScriptKeys& script, const std::filesystem::path& file);
Result<ScriptKeys> load_keys(const std::filesystem::path& file);

}  // namespace pliant
