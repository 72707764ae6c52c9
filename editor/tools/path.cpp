// Path keys set by clicking on a touched surface; dragged along it; depth by the wheel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/kinematic.h"
#include "editor/core/path_editing.h"
#include "editor/tools/path_drawing.h"
#include "editor/tools/tools.h"
#include "editor/viewport/solid_view.h"
#include "viewer/ui/widgets.h"

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
