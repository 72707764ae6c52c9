#include "editor/play/record_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/core/path_editing.h"

namespace pliant {
namespace {

// [m] The largest distance of the polyline `rows` from the run.
double farthest(const std::vector<PathRow>& run, const std::vector<PathRow>& rows) {
  double worst = 0.0;
  std::size_t k = 0;
  for (const PathRow& each : run) {
    while (k + 2 < rows.size() && rows[k + 1].time < each.time) ++k;
    if (rows.size() < 2) return worst;
    const double s = std::clamp((each.time - rows[k].time) / (rows[k + 1].time - rows[k].time), 0.0, 1.0);
    const dvec3 at = rows[k].position + s * (rows[k + 1].position - rows[k].position);
    worst = std::max(worst, length(each.position - at));
  }
  return worst;
}

// Keeps the key's position and expresses it relative to the closest surface point.
void anchor(PathKey& key, const std::vector<PathSurface>& surfaces) {
  const dvec3 p = key.position();
  double nearest = 1e300;
  for (const PathSurface& each : surfaces) {
    const SurfaceHit hit = each.surface->closest(p - each.origin, nearest);
    if (!hit.valid()) continue;
    const dvec3 foot = hit.point + each.origin, off = p - foot;
    const double away = length(off);
    if (away >= nearest) continue;
    nearest = away;
    key.height = dot(off, hit.normal) < 0.0 ? -away : away;
    // On the surface itself the direction is undefined.
    key.normal = away > 1e-6 ? off / key.height : hit.normal;
    key.anchor = p - key.height * key.normal;
  }
}

// The document with the path as the script of `name`'s device.
Result<State> with_recorded(const Editor& editor, const std::string& name, double radius, const ScriptKeys& keys,
                            NodeId fresh, NodeId& shown) {
  Result<State> next(editor.state());
  const DocumentNode* node = next->find(name);
  if (!node || !(node->node.probe || node->node.handle)) {  // the run's own probe
    LevelNode probe;
    probe.name = unique_name(*next, "probe");
    probe.probe.emplace();
    probe.probe->radius = radius;
    probe.device.emplace();
    probe.probe_device = probe.name;
    probe.local.translation = vec3(keys.keys.front().position());
    next = with_node(*next, fresh, kNoNode, std::move(probe));
    if (!next) return next;
    node = next->find(fresh);
  }
  shown = node->id;
  NodeId device = device_of(*next, node->id);
  if (device == kNoNode) {
    const NodeIds one(&shown, 1);
    next = with_component(*next, one, "haptic_device");
    if (next) next = with_value(*next, one, node->node.probe ? "probe" : "handle", "device", node->node.name);
    if (!next) return next;
    device = shown;
  }
  return with_script(*next, device, script_file_of(*next, editor.document.folder(), device), keys);
}

}  // namespace

Result<RecordedPath> path_of_past(const PlayPast& past, std::size_t which, std::size_t count, double rate,
                                  double tolerance, const std::vector<PathSurface>& surfaces) {
  std::vector<PathRow> run;
  for (std::size_t t = 0; t < past.ticks.size() && which < count; ++t)
    if (const RecordedPose& pose = past.poses[t * count + which]; pose.ready)
      run.push_back({static_cast<double>(past.ticks[t]) / rate, pose.position, {1, 0, 0, 0}});
  // Removes rest before the start and after the end of the motion.
  const auto rests = [&](const dvec3& at) {
    return [&at, tolerance](const PathRow& row) { return length(row.position - at) <= tolerance; };
  };
  const dvec3 begin = run.empty() ? dvec3(0) : run.front().position, end = run.empty() ? dvec3(0) : run.back().position;
  const auto first = std::find_if_not(run.begin(), run.end(), rests(begin));
  if (first == run.end()) return Error{"path", "did not move in this run"};
  const auto last = std::find_if_not(run.rbegin(), run.rend(), rests(end)).base();
  run = {first - 1, std::min(last + 1, run.end())};
  RecordedPath out;
  out.begin = run.front().time;
  for (PathRow& row : run) row.time -= out.begin;
  Path path;
  path.rows = run;
  out.keys = smooth_keys_of(path, tolerance);
  out.error = farthest(run, path_of(out.keys).rows);
  for (PathKey& key : out.keys.keys) anchor(key, surfaces);
  return out;
}

void record_path(Editor& editor, Play& play, const std::string& name, double tolerance) {
  const std::vector<PlayEffector>& all = play.status().effectors;
  const auto of = std::find_if(all.begin(), all.end(), [&](const PlayEffector& each) { return each.name == name; });
  const std::shared_ptr<const PlayPast> past = of == all.end() ? nullptr : play.past();
  if (!past || past->ticks.empty())
    return editor.say("no run has moved " + name + " yet: press Play, move it, then record", Severity::kWarning);
  if (past->ticks.size() >= PlayPast::kMostTicks)
    editor.say(fmt::format("only the first {} ticks of a run can be recorded", PlayPast::kMostTicks));
  struct Ground {
    PathSurface made;
    std::shared_ptr<const DocumentMesh> mesh;
    dmat3 frame{1};
  };
  std::vector<Ground> grounds;
  for (const auto& each : editor.state().nodes) {
    if (each->node.mesh < 0 || !each->node.in_scene || each->node.handle) continue;
    const dmat4 frame = editor.state().to_world(each->id);
    grounds.push_back({{editor.surface_of(each->id), dvec3(frame[3])},
                       editor.state().meshes[static_cast<std::size_t>(each->node.mesh)],
                       dmat3(frame)});
  }
  const auto which = static_cast<std::size_t>(of - all.begin());
  editor.jobs.start(
      "record path", "Recording the path of " + name,
      [=, &play, grounds = std::move(grounds), count = all.size(), rate = play.status().rate, radius = of->radius,
       document = editor.documents](const Jobs::Stop& stop) -> std::function<void(Editor&)> {
        std::vector<PathSurface> surfaces;
        for (Ground ground : grounds) {
          if (!ground.made.surface)
            if (auto made = PaintSurface::make(*ground.mesh, ground.frame, &stop); made)
              ground.made.surface = std::make_shared<const PaintSurface>(*std::move(made));
          if (ground.made.surface) surfaces.push_back(ground.made);
        }
        if (stop) return {};
        auto path =
            std::make_shared<Result<RecordedPath>>(path_of_past(*past, which, count, rate, tolerance, surfaces));
        return [=, &play](Editor& to) {
          if (to.documents != document) return;
          if (!*path) return to.say(name + " " + path->error().what, Severity::kWarning);
          NodeId shown = kNoNode;
          const ScriptKeys& keys = (*path)->keys;
          if (!to.apply("Record a path", with_recorded(to, name, radius, keys, to.document.new_id(), shown))) return;
          to.selected = {shown};
          play.sources.erase(name);  // it follows the path from the next Play on
          to.say(fmt::format(
              "The path of {}: {} keys over {:.2f} s, at most {:.2g} mm from the run; saved with the "
              "level",
              to.state().find(shown)->node.name, keys.keys.size(), keys.keys.back().time, 1e3 * (*path)->error));
        };
      });
}

}  // namespace pliant
