// Path keys set by clicking on a touched surface; dragged along it; depth by the wheel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/kinematic.h"
#include "components/probe_shape.h"
#include "editor/app/path_editing.h"
#include "editor/tools/path_drawing.h"
#include "editor/tools/tools.h"
#include "editor/ui/widgets.h"
#include "editor/viewport/solid_view.h"

namespace pliant {
namespace {

constexpr double kPickReach = 10.0;      // [point] picking distance of a key
constexpr double kWheel = 0.0005;        // [m] of depth per click
constexpr std::size_t kMostLabels = 20;  // with more keys, their times would overlap
constexpr std::size_t kMostLines = 400;  // of the curve that is drawn

struct PlaceUnder {
  dvec3 point, normal;
};
// On the nearest touchable surface under the mouse.
std::optional<PlaceUnder> place_under(Editor& editor, const ViewportInput& in) {
  const ViewRay ray = in.ray();
  std::optional<PlaceUnder> found;
  double nearest = 1e300;
  for (const NodeId id : path_grounds(editor.state())) {
    const auto surface = editor.ground_of(id).surface;
    if (!surface) continue;
    // The surface frame equals the world frame except for the node's position.
    const dvec3 origin(editor.state().to_world(id)[3]);
    const SurfaceHit hit = surface->hit({ray.from - origin, ray.along});
    if (!hit.valid()) continue;
    const double away = length(hit.point + origin - ray.from);
    if (away >= nearest) continue;
    nearest = away;
    found = PlaceUnder{hit.point + origin, hit.normal};
  }
  return found;
}

// Starts preparing every surface that a click may hit.
bool prepared(Editor& editor) {
  bool ready = true;
  for (const NodeId id : path_grounds(editor.state())) ready = editor.ground_of(id).ready && ready;
  return ready;
}

std::optional<std::size_t> key_near(const ScriptKeys& keys, const ViewportInput& in) {
  std::optional<std::size_t> found;
  double nearest = static_cast<double>(ui::px(static_cast<float>(kPickReach)));
  for (std::size_t i = 0; i < keys.keys.size(); ++i) {
    const auto at = on_picture(in.view, in.orthographic, in.width, in.height, keys.keys[i].position());
    if (!at) continue;
    const double away = std::hypot(at->x - in.x, at->y - in.y);
    if (away > nearest) continue;
    nearest = away;
    found = i;
  }
  return found;
}

void add_key(Editor& editor, NodeId node, const ScriptKeys& keys, const PlaceUnder& place) {
  ScriptKeys next = keys;
  const double clear = path_clearance(editor, node);
  if (next.keys.empty()) next.along = true;
  // Off the surface, heights refer to the centre.
  const double radius = next.along ? 0.0 : tip_of(editor.state(), node).value_or(PathTip{}).radius;
  PathKey key{0.0, place.point, place.normal, radius - editor.path_depth};
  if (next.keys.empty()) {  // it comes from the air
    next.keys.push_back({0.0, place.point, place.normal, clear});
    key.time = (clear + editor.path_depth) / editor.path_speed;
  } else {
    const double way = length(next.keys.back().position() - key.position());
    key.time = next.keys.back().time + std::max(way / editor.path_speed, 0.1);
  }
  editor.path_key = next.keys.size();
  next.keys.push_back(key);
  set_keys_of_node(editor, node, next, "Add a key");
}

class PathTool : public ViewTool {
 public:
  const char* name() const override { return "Path"; }
  const char* sign() const override { return "~"; }
  const char* hint() const override {
    return "Click on the organ sets a key, drag moves it, wheel over it presses deeper, Delete removes it, Alt turns "
           "the view.";
  }
  bool usable(const Editor& editor) const override { return path_node(editor) != kNoNode; }

  bool use(Editor& editor, const ViewportInput& in) override {
    const NodeId node = path_node(editor);
    const ScriptKeys keys = keys_of_node(editor, node);
    const bool ready = prepared(editor);
    if (waiting_ && ready) {
      const ViewportInput click = *std::exchange(waiting_, std::nullopt);
      if (const auto place = place_under(editor, click)) add_key(editor, node, keys, *place);
      return true;
    }
    near_ = in.over || dragging_ ? key_near(keys, in) : std::nullopt;
    if (in.over && near_ && ImGui::GetIO().MouseWheel != 0) {
      ScriptKeys next = keys;
      next.keys[*near_].height -= kWheel * static_cast<double>(ImGui::GetIO().MouseWheel);
      set_keys_of_node(editor, node, next, "Depth of a key", "depth");
      return true;
    }
    if (in.pressed) {
      pressed_x_ = in.x;
      pressed_y_ = in.y;
      grabbed_ = near_;
      editor.path_key = near_ ? *near_ : editor.path_key;
    }
    if (grabbed_ && in.held) {
      dragging_ = dragging_ || std::hypot(in.x - pressed_x_, in.y - pressed_y_) > 3.0;
      if (dragging_ && *grabbed_ < keys.keys.size()) {
        const auto place = place_under(editor, in);
        if (place) {
          ScriptKeys next = keys;
          next.keys[*grabbed_].anchor = place->point;
          next.keys[*grabbed_].normal = place->normal;
          set_keys_of_node(editor, node, next, "Move a key", "key");
        }
      }
      return true;
    }
    if (in.released) {
      const bool clicked = !dragging_ && std::hypot(in.x - pressed_x_, in.y - pressed_y_) < 4.0;
      const bool had = grabbed_.has_value();
      dragging_ = false;
      grabbed_.reset();
      if (clicked && !had && !ready) {
        waiting_ = in;
        editor.say("The surfaces are being prepared; the key is set when they are.");
        return true;
      }
      if (clicked && !had)
        if (const auto place = place_under(editor, in)) {
          add_key(editor, node, keys, *place);
          return true;
        }
      return had;
    }
    return false;
  }

  void leave(Editor&) override {
    waiting_.reset();
    grabbed_.reset();
    dragging_ = false;
  }

  void overlay(Editor& editor, const ViewportInput& in, ImDrawList& list) override {
    resting_.find(editor);
    const ScriptKeys keys = keys_of_node(editor, path_node(editor));
    for (std::size_t i = 0; i < keys.keys.size(); ++i) {
      const auto at = on_picture(in.view, in.orthographic, in.width, in.height, keys.keys[i].position());
      if (!at) continue;
      const ImVec2 p(in.corner.x + static_cast<float>(at->x), in.corner.y + static_cast<float>(at->y));
      const bool active = near_ == i || editor.path_key == i;
      const float size = active ? 6.0f : keys.keys.size() <= kMostLabels ? 4.5f : 3.0f;
      list.AddCircleFilled(p, ui::px(size), ui::color(ui::palette().accent));
      list.AddCircle(p, ui::px(size + 1.0f), ui::color(ui::palette().window), 0, ui::px(1.5f));
      if (const std::string text = fmt::format("{:.1f} s", keys.keys[i].time);
          near_ == i || keys.keys.size() <= kMostLabels)
        list.AddText({p.x + ui::px(10), p.y - ui::px(8)}, ui::color(ui::palette().text), text.c_str());
      ui::known_at("Key " + std::to_string(i + 1), {p.x - ui::px(4), p.y - ui::px(4)},
                   {p.x + ui::px(4), p.y + ui::px(4)});
    }
  }

  void lines(const Editor& editor, std::vector<ViewLine>& lines) const override {
    resting_.draw(lines);
    const ScriptKeys keys = keys_of_node(editor, path_node(editor));
    if (keys.keys.size() < 2) return;
    const double begin = keys.keys.front().time, length = keys.keys.back().time - begin;
    const ImVec4& c = ui::palette().accent;
    vec3 before(keys.keys.front().position());
    for (std::size_t i = 1; i <= kMostLines; ++i) {
      const vec3 here(position_at(keys, begin + length * static_cast<double>(i) / kMostLines));
      lines.push_back({before, here, vec4(c.x, c.y, c.z, 0.9f), true});
      before = here;
    }
    draw_ghosts(editor, keys, lines);
  }

 private:
<<<<<<< HEAD
  // A body that rests elsewhere than it is drawn: keys are set on it where it rests.
  struct Sagging {
    std::shared_ptr<const PaintSurface> surface;
    dvec3 origin{0};  // [m] world
  };
  void find_sagging(Editor& editor) {
    sagging_.clear();
    if (path_node(editor) == kNoNode || editor.playing) return;
    for (const NodeId id : path_grounds(editor.state())) {
      const Editor::Ground ground = editor.ground_of(id);
      if (!ground.surface) continue;
      const std::string name = "`" + editor.state().find(id)->node.name + "`";
      const bool far = ground.sag > kSeenSag * static_cast<double>(ground.surface->mesh().box.diagonal());
      if (far) sagging_.push_back({ground.surface, dvec3(editor.state().to_world(id)[3])});
      const bool known = std::any_of(said_.begin(), said_.end(), [&](const auto& s) { return s == ground.surface; });
      if (known || (!far && ground.held)) continue;
      said_.push_back(ground.surface);
      if (!ground.held)
        editor.say(name +
                       " finds no rest on what is pinned: keys are set on it as it is drawn, and the run may find it "
                       "elsewhere; pin more of it",
                   Severity::kWarning);
      else
        editor.say(fmt::format("{} sags {:.2g} mm on what is pinned: keys are set on it where it rests (the lines){}",
                               name, 1e3 * ground.sag,
                               ground.falls ? ", to which it falls when the run begins; `Settled` begins there" : ""),
                   Severity::kWarning);
    }
  }
  static void draw_resting(const Sagging& it, std::vector<ViewLine>& lines) {
    const Mesh& mesh = it.surface->mesh();
    const std::size_t every = 1 + 3 * mesh.triangles.size() / (2 * kMostRestEdges);
    const ImVec4& c = ui::palette().warning;
    std::size_t edge = 0;
    for (const uvec3& t : mesh.triangles)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if (a > b || edge++ % every != 0) continue;
        lines.push_back({vec3(it.origin + dvec3(mesh.position(a))), vec3(it.origin + dvec3(mesh.position(b))),
                         vec4(c.x, c.y, c.z, 0.4f), true});
      }
  }

  // The probe or tool as it is at each key: edges of its mesh, or its tip.
  static void ghosts(const Editor& editor, const ScriptKeys& keys, std::vector<ViewLine>& lines) {
    const DocumentNode* const it = editor.state().find(effector_of(editor.state(), path_node(editor)));
    if (!it || !keys.rows) return;
    const std::vector<std::pair<vec3, vec3>> shape = shape_of(editor.state(), *it, keys.tip);
    const std::size_t shown = std::min(keys.keys.size(), kMostGhosts);
    for (std::size_t i = 0; i < keys.keys.size(); ++i) {
      const bool active = editor.path_key == i;
      if (i >= shown && !active) continue;
      const ImVec4& c = active ? ui::palette().accent : ui::palette().text;
      const PathRow at = pose_at(keys, keys.keys[i].time);
      const auto world = [&](const vec3& p) { return vec3(at.position + at.rotation * dvec3(p)); };
      for (const auto& [from, to] : shape)
        lines.push_back({world(from), world(to), vec4(c.x, c.y, c.z, active ? 0.55f : 0.25f), false});
    }
  }

  // [m] Device frame.
  static std::vector<std::pair<vec3, vec3>> shape_of(const State& state, const DocumentNode& it, const PathTip& tip) {
    std::vector<std::pair<vec3, vec3>> out;
    if (it.node.mesh >= 0 && !it.node.probe) {
      const dmat4 world = state.to_world(it.id);
      const Pose pose = rigid_part(world);
      std::size_t triangles = 0;
      const DocumentMesh& mesh = *state.meshes[static_cast<std::size_t>(it.node.mesh)];
      for (const Primitive& p : mesh.primitives) triangles += p.index.size() / 3;
      const std::size_t every = 1 + triangles / kMostGhostEdges;
      for (const Primitive& p : mesh.primitives)
        for (std::size_t t = 0; t + 2 < p.index.size(); t += 3 * every) {
          const auto place = [&](std::size_t i) {
            return vec3(pose.to_local(dvec3(world * glm::dvec4(dvec3(p.position[p.index[i]]), 1.0))));
          };
          out.emplace_back(place(t), place(t + 1));
        }
      return out;
    }
    const dvec3 axis = tip.axis == dvec3(0) ? dvec3(0, 1, 0) : tip.axis;
    const dvec3 side = normalize(std::abs(axis.x) < 0.9 ? cross(axis, dvec3(1, 0, 0)) : cross(axis, dvec3(0, 1, 0)));
    const dvec3 frame[3] = {side, cross(axis, side), axis};
    constexpr int kAround = 24;
    for (int plane = 0; plane < 3; ++plane)
      for (int i = 0; i < kAround; ++i) {
        const auto on = [&](int k) {
          const double a = 2.0 * glm::pi<double>() * k / kAround;
          return vec3(tip.place + tip.radius * (std::cos(a) * frame[plane] + std::sin(a) * frame[(plane + 1) % 3]));
        };
        out.emplace_back(on(i), on(i + 1));
      }
    for (const ProbePart& part : it.node.probe ? probe_parts(*it.node.probe) : std::vector<ProbePart>())
      if (!part.is_sphere())
        for (const dvec3& beside : {frame[0], -frame[0], frame[1], -frame[1]})
          out.emplace_back(vec3(part.from + tip.radius * beside), vec3(part.to + tip.radius * beside));
    return out;
  }

  struct PlaceUnder {
    dvec3 point, normal;
  };
  // On the nearest touchable surface under the mouse.
  static std::optional<PlaceUnder> place_under(Editor& editor, const ViewportInput& in) {
    const ViewRay ray = in.ray();
    std::optional<PlaceUnder> found;
    double nearest = 1e300;
    for (const NodeId id : path_grounds(editor.state())) {
      const auto surface = editor.ground_of(id).surface;
      if (!surface) continue;
      // The surface frame equals the world frame except for the node's position.
      const dvec3 origin(editor.state().to_world(id)[3]);
      const SurfaceHit hit = surface->hit({ray.from - origin, ray.along});
      if (!hit.valid()) continue;
      const double away = length(hit.point + origin - ray.from);
      if (away >= nearest) continue;
      nearest = away;
      found = PlaceUnder{hit.point + origin, hit.normal};
    }
    return found;
  }

  // Starts preparing every surface that a click may hit.
  static bool prepared(Editor& editor) {
    bool ready = true;
    for (const NodeId id : path_grounds(editor.state())) ready = editor.ground_of(id).ready && ready;
    return ready;
  }

  static std::optional<std::size_t> key_near(const ScriptKeys& keys, const ViewportInput& in) {
    std::optional<std::size_t> found;
    double nearest = static_cast<double>(ui::px(static_cast<float>(kReach)));
    for (std::size_t i = 0; i < keys.keys.size(); ++i) {
      const auto at = on_picture(in.view, in.orthographic, in.width, in.height, keys.keys[i].position());
      if (!at) continue;
      const double away = std::hypot(at->x - in.x, at->y - in.y);
      if (away > nearest) continue;
      nearest = away;
      found = i;
    }
    return found;
  }

  static void add_key(Editor& editor, NodeId node, const ScriptKeys& keys, const PlaceUnder& place) {
    ScriptKeys next = keys;
    const double clear = path_clearance(editor, node);
    if (next.keys.empty()) next.along = true;
    // Off the surface, heights refer to the centre.
    const double radius = next.along ? 0.0 : tip_of(editor.state(), node).value_or(PathTip{}).radius;
    PathKey key{0.0, place.point, place.normal, radius - editor.path_depth};
    if (next.keys.empty()) {  // it comes from the air
      next.keys.push_back({0.0, place.point, place.normal, clear});
      key.time = (clear + editor.path_depth) / editor.path_speed;
    } else {
      const double way = length(next.keys.back().position() - key.position());
      key.time = next.keys.back().time + std::max(way / editor.path_speed, 0.1);
    }
    editor.path_key = next.keys.size();
    next.keys.push_back(key);
    set_keys_of_node(editor, node, next, "Add a key");
  }

=======
>>>>>>> 6d05a05ea98e873313020e8f438e36e15c4bc391
  std::optional<std::size_t> near_, grabbed_;
  bool dragging_ = false;
  double pressed_x_ = 0, pressed_y_ = 0;  // [pixel]
  RestingBodies resting_;
  std::optional<ViewportInput> waiting_;  // a click that came before the surfaces were prepared
};

}  // namespace

std::unique_ptr<ViewTool> make_path_tool() {
  return std::make_unique<PathTool>();
}

}  // namespace pliant
