#include "editor/document/script_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <sstream>

#include "content/files/file_io.h"
#include "content/level/script.h"

namespace pliant {
namespace {

constexpr const char* kKeyWord = "# key ";
constexpr const char* kStraight = "# straight";
constexpr double kTolerance = 2e-4;  // [m] of keys made from rows

constexpr const char *kTipWord = "# tip ", *kMadeWord = "# made ", *kAlong = "# along";

std::uint64_t hash_of(std::string_view text) {  // FNV-1a
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

// The text after the comments of a script.
std::string_view rows_of_text(std::string_view text) {
  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text;
}

// The slope at key i that keeps each piece monotone.
dvec3 slope(const std::vector<PathKey>& keys, std::size_t i) {
  if (i == 0 || i + 1 == keys.size()) return dvec3(0);  // starts and ends at rest
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

bool ScriptKeys::operator==(const ScriptKeys& o) const {
  if (keys != o.keys || smooth != o.smooth || repeats != o.repeats || along != o.along || !(tip == o.tip)) return false;
  if (!rows || !o.rows) return !rows == !o.rows;
  // Rotations are normalised on reading, so they are not compared.
  return rows == o.rows ||
         std::equal(rows->begin(), rows->end(), o.rows->begin(), o.rows->end(),
                    [](const PathRow& a, const PathRow& b) { return a.time == b.time && a.position == b.position; });
}

PathRow pose_at(const ScriptKeys& script, double time) {
  if (!script.rows || script.rows->empty()) return {time, position_at(script, time), {1, 0, 0, 0}};
  const std::vector<PathRow>& rows = *script.rows;
  const auto next =
      std::upper_bound(rows.begin(), rows.end(), time, [](double t, const PathRow& row) { return t < row.time; });
  if (next == rows.begin()) return rows.front();
  if (next == rows.end()) return rows.back();
  const PathRow &a = *(next - 1), &b = *next;
  const double share = (time - a.time) / (b.time - a.time);
  return {time, a.position + share * (b.position - a.position), glm::slerp(a.rotation, b.rotation, share)};
}

double height_at(const ScriptKeys& script, double time) {
  ScriptKeys heights = script;
  heights.rows = nullptr;
  for (PathKey& key : heights.keys) {
    key.anchor = dvec3(0);
    key.normal = dvec3(0, 1, 0);
  }
  return position_at(heights, time).y;
}

dvec3 position_at(const ScriptKeys& script, double time) {
  const std::vector<PathKey>& keys = script.keys;
  if (script.rows && !script.rows->empty() && !keys.empty()) {
    const PathRow row = pose_at(script, time);
    const dvec3 middle = row.position + row.rotation * script.tip.place;
    dvec3 out = row.rotation * script.tip.axis;
    if (script.tip.axis == dvec3(0)) {  // in the direction in which the neighbouring keys are pressed
      const auto after =
          std::upper_bound(keys.begin(), keys.end(), time, [](double t, const PathKey& key) { return t < key.time; });
      const PathKey& b = after == keys.end() ? keys.back() : *after;
      const PathKey& a = after == keys.begin() ? b : *(after - 1);
      const double share = b.time > a.time ? std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0) : 0.0;
      out = a.normal + share * (b.normal - a.normal);
      if (const double size = glm::length(out); size > 1e-9) out /= size;
    }
    return middle - script.tip.radius * out;
  }
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
  if (script.rows) {
    path.rows = *script.rows;
    path.turns = script.tip.axis != dvec3(0);
    return path;
  }
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
  for (bool more = true; more;) {  // adds a key where each piece has its largest error
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
  // Removes keys that are not needed. A key influences two pieces on either side.
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

Result<std::string> text_of_keys(const ScriptKeys& script, const std::string& name) {
  const Path path = path_of(script);
  std::string head, rows = path.turns ? "time_s,x,y,z,qw,qx,qy,qz\n" : "time_s,x,y,z\n";
  for (const PathRow& row : path.rows) {
    rows += fmt::format("{:.14g},{:.14g},{:.14g},{:.14g}", row.time, row.position.x, row.position.y, row.position.z);
    const dquat& q = row.rotation;
    rows += path.turns ? fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}\n", q.w, q.x, q.y, q.z) : "\n";
  }
  if (!script.smooth) head += std::string(kStraight) + "\n";
  if (script.along) head += std::string(kAlong) + "\n";
  if (script.rows) {
    const PathTip& t = script.tip;
    head += fmt::format(
        "{}{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n{}{:016x}\n",
        kTipWord, t.place.x, t.place.y, t.place.z, t.radius, t.axis.x, t.axis.y, t.axis.z, t.stands.w, t.stands.x,
        t.stands.y, t.stands.z, kMadeWord, hash_of(rows));
  }
  for (const PathKey& k : script.keys)
    head += fmt::format("{}{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", kKeyWord, k.time,
                        k.anchor.x, k.anchor.y, k.anchor.z, k.normal.x, k.normal.y, k.normal.z, k.height);
  std::string text = head + rows;
  if (text.size() > most(limits::kScriptFile))
    return error_at(name, beyond("is not written, as no run would read it: it", limits::kScriptFile,
                                 static_cast<double>(text.size()), "make the path shorter"));
  if (const Result<Path> again = parse_script(text, name); !again)
    return Error{again.error().where, "is not written, as no run would read it: " + again.error().what,
                 again.error().cure, again.error().code};
  return text;
}

Status save_keys(const ScriptKeys& script, const std::filesystem::path& file) {
  const Result<std::string> text = text_of_keys(script, file.string());
  if (!text) return text.error();
  return write_file(file, std::span(reinterpret_cast<const std::uint8_t*>(text->data()), text->size()));
}

Result<ScriptKeys> load_keys(const std::filesystem::path& file) {
  Result<Path> path = load_script(file);
  if (!path) return path.error();
  if (path->grips)
    return Error{file.string(), "has a column `grip`, which the editor would lose", "edit the file as text"};
  ScriptKeys script;
  script.repeats = path->repeats;
  const Result<Bytes> bytes = read_file(file, limits::kScriptFile);
  if (!bytes) return bytes.error();
  const std::string text(bytes->begin(), bytes->end());
  std::istringstream in(text);
  std::uint64_t made = 0;
  bool has_tip = false;
  for (std::string line; std::getline(in, line) && !line.empty() && line[0] == '#';) {
    if (line == kStraight) script.smooth = false;
    if (line == kAlong) script.along = true;
    if (line.rfind(kMadeWord, 0) == 0) made = std::strtoull(line.c_str() + std::strlen(kMadeWord), nullptr, 16);
    if (line.rfind(kTipWord, 0) == 0) {
      std::istringstream words(line.substr(std::strlen(kTipWord)));
      PathTip& t = script.tip;
      has_tip = static_cast<bool>(words >> t.place.x >> t.place.y >> t.place.z >> t.radius >> t.axis.x >> t.axis.y >>
                                  t.axis.z >> t.stands.w >> t.stands.x >> t.stands.y >> t.stands.z);
    }
    if (line.rfind(kKeyWord, 0) != 0) continue;
    std::istringstream words(line.substr(6));
    PathKey k;
    if (words >> k.time >> k.anchor.x >> k.anchor.y >> k.anchor.z >> k.normal.x >> k.normal.y >> k.normal.z >> k.height)
      script.keys.push_back(k);
  }
  // Stored keys are used only if they still produce the rows, which may have been edited.
  const auto ascend = [](const PathKey& a, const PathKey& b) { return a.time >= b.time; };
  bool same = script.keys.size() > (has_tip ? 0u : 1u) &&
              std::adjacent_find(script.keys.begin(), script.keys.end(), ascend) == script.keys.end();
  if (has_tip) {
    same = same && made == hash_of(rows_of_text(text));
    script.rows = std::make_shared<const std::vector<PathRow>>(std::move(path->rows));
    if (same) return script;
    Path as_it_is;
    as_it_is.rows = *script.rows;
    as_it_is.repeats = script.repeats;
    return keys_of(as_it_is, kTolerance);
  }
  for (std::size_t i = 0; same && i < path->rows.size(); ++i)
    same = length(position_at(script, path->rows[i].time) - path->rows[i].position) < 1e-6;
  return same ? script : keys_of(*path, kTolerance);
}

}  // namespace pliant
