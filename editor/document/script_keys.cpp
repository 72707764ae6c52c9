#include "editor/document/script_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "content/files/file_io.h"
#include "content/level/script.h"

namespace pliant {
namespace {

constexpr const char* kKeyWord = "# key ";
constexpr const char* kStraight = "# straight";
constexpr double kTolerance = 2e-4;  // [m] of keys made from rows

// The slope at key i that keeps each piece monotone.
dvec3 slope(const std::vector<PathKey>& keys, std::size_t i) {
  if (i == 0 || i + 1 == keys.size()) return dvec3(0);  // begins and ends at rest
  const double before = keys[i].time - keys[i - 1].time, after = keys[i + 1].time - keys[i].time;
  const dvec3 left = (keys[i].position() - keys[i - 1].position()) / before,
              right = (keys[i + 1].position() - keys[i].position()) / after;
  dvec3 out(0);
  for (int c = 0; c < 3; ++c) {
    if (left[c] * right[c] <= 0.0) continue;
    const double w1 = 2 * after + before, w2 = after + 2 * before;  // harmonic mean (Fritsch and Butland 1984)
    out[c] = (w1 + w2) / (w1 / left[c] + w2 / right[c]);
  }
  return out;
}

}  // namespace

dvec3 position_at(const ScriptKeys& script, double time) {
  const std::vector<PathKey>& keys = script.keys;
  if (keys.empty()) return dvec3(0);
  if (time <= keys.front().time) return keys.front().position();
  if (time >= keys.back().time) return keys.back().position();
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), time, [](double t, const PathKey& key) { return t < key.time; });
  const auto i = static_cast<std::size_t>(next - keys.begin()) - 1;
  const double h = keys[i + 1].time - keys[i].time, s = (time - keys[i].time) / h;
  const dvec3 a = keys[i].position(), b = keys[i + 1].position();
  if (!script.smooth) return a + s * (b - a);
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a + (s3 - 2 * s2 + s) * h * slope(keys, i) + (3 * s2 - 2 * s3) * b +
         (s3 - s2) * h * slope(keys, i + 1);
}

Path path_of(const ScriptKeys& script) {
  Path path;
  path.repeats = script.repeats;
  if (script.keys.empty()) return path;
  const auto add = [&](double time) { path.rows.push_back({time, position_at(script, time), {1, 0, 0, 0}}); };
  for (std::size_t i = 0; i + 1 < script.keys.size(); ++i) {
    const double from = script.keys[i].time, to = script.keys[i + 1].time;
    const auto steps = script.smooth ? static_cast<int>(std::ceil((to - from) / kScriptStep)) : 1;
    for (int k = 0; k < steps; ++k) add(from + (to - from) * k / steps);
  }
  add(script.keys.back().time);
  return path;
}

ScriptKeys keys_of(const Path& path, double tolerance) {
  ScriptKeys script;
  script.smooth = false;
  script.repeats = path.repeats;
  const std::vector<PathRow>& rows = path.rows;
  if (rows.empty()) return script;
  std::vector<bool> kept(rows.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, rows.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double s = (rows[i].time - rows[first].time) / (rows[last].time - rows[first].time);
      const double away =
          length(rows[i].position - (rows[first].position + s * (rows[last].position - rows[first].position)));
      if (away <= worst) continue;
      worst = away;
      at = i;
    }
    if (at == first) continue;
    kept[at] = true;
    open.push_back({first, at});
    open.push_back({at, last});
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (kept[i]) script.keys.push_back({rows[i].time, rows[i].position, dvec3(0), 0.0});
  return script;
}

ScriptKeys smooth_keys_of(const Path& path, double tolerance) {
  ScriptKeys script;
  script.repeats = path.repeats;
  const std::vector<PathRow>& rows = path.rows;
  if (rows.empty()) return script;
  const auto key_at = [&](std::size_t row) { return PathKey{rows[row].time, rows[row].position, dvec3(0), 0.0}; };
  const auto off = [&](const ScriptKeys& keys, std::size_t row) {
    return length(position_at(keys, rows[row].time) - rows[row].position);
  };
  std::vector<std::size_t> kept{0};
  if (rows.size() > 1) kept.push_back(rows.size() - 1);
  for (bool more = true; more;) {  // a key where each piece is farthest off
    more = false;
    script.keys.clear();
    for (const std::size_t row : kept) script.keys.push_back(key_at(row));
    std::vector<std::size_t> next;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      next.push_back(kept[k]);
      double worst = tolerance;
      std::size_t at = kept[k];
      for (std::size_t i = kept[k] + 1; i < kept[k + 1]; ++i)
        if (const double away = off(script, i); away > worst) {
          worst = away;
          at = i;
        }
      if (at == kept[k]) continue;
      next.push_back(at);
      more = true;
    }
    next.push_back(kept.back());
    kept = std::move(next);
  }
  // Each that its neighbours can do without. A key has a say in the two pieces on either side of it.
  for (std::size_t k = 1; k + 1 < kept.size();) {
    const std::size_t first = k < 3 ? 0 : k - 3, last = std::min(k + 3, kept.size() - 1);
    ScriptKeys near;
    for (std::size_t i = first; i <= last; ++i)
      if (i != k) near.keys.push_back(key_at(kept[i]));
    bool needed = false;
    const std::size_t from = kept[std::max(first, k < 2 ? 0 : k - 2)], to = kept[std::min(last, k + 2)];
    for (std::size_t i = from; i < to && !needed; ++i) needed = off(near, i) > tolerance;
    if (needed)
      ++k;
    else
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
  }
  script.keys.clear();
  for (const std::size_t row : kept) script.keys.push_back(key_at(row));
  return script;
}

Status save_keys(const ScriptKeys& script, const std::filesystem::path& file) {
  std::string text;
  if (!script.smooth) text += std::string(kStraight) + "\n";
  for (const PathKey& k : script.keys)
    text += fmt::format("{}{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", kKeyWord, k.time,
                        k.anchor.x, k.anchor.y, k.anchor.z, k.normal.x, k.normal.y, k.normal.z, k.height);
  text += "time_s,x,y,z\n";
  for (const PathRow& row : path_of(script).rows)
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", row.time, row.position.x, row.position.y, row.position.z);
  return write_file(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<ScriptKeys> load_keys(const std::filesystem::path& file) {
  Result<Path> path = load_script(file);
  if (!path) return path.error();
  ScriptKeys script;
  script.repeats = path->repeats;
  const Result<Bytes> bytes = read_file(file, limits::kScriptFile);
  if (!bytes) return bytes.error();
  std::istringstream in(std::string(bytes->begin(), bytes->end()));
  for (std::string line; std::getline(in, line) && !line.empty() && line[0] == '#';) {
    if (line == kStraight) script.smooth = false;
    if (line.rfind(kKeyWord, 0) != 0) continue;
    std::istringstream words(line.substr(6));
    PathKey k;
    if (words >> k.time >> k.anchor.x >> k.anchor.y >> k.anchor.z >> k.normal.x >> k.normal.y >> k.normal.z >> k.height)
      script.keys.push_back(k);
  }
  // Keys count only where they still make the rows: somebody may have changed those.
  const auto ascend = [](const PathKey& a, const PathKey& b) { return a.time >= b.time; };
  bool same =
      script.keys.size() > 1 && std::adjacent_find(script.keys.begin(), script.keys.end(), ascend) == script.keys.end();
  for (std::size_t i = 0; same && i < path->rows.size(); ++i)
    same = length(position_at(script, path->rows[i].time) - path->rows[i].position) < 1e-6;
  return same ? script : keys_of(*path, kTolerance);
}

}  // namespace pliant
