#include "editor/tools/gizmo.h"

#include <algorithm>
#include <cmath>

#include "viewer/ui/widgets.h"

namespace pliant {

GizmoPicture picture_of(const ViewportInput& in) {
  return {in.view, in.orthographic, in.width, in.height};
}

bool GizmoTool::use(Editor& editor, const ViewportInput& in) {
  const bool busy = dragging_ || typing_;
  if (!busy) {
    hovered_ = GizmoPart::kNone;
    if (editor.selected.empty()) return false;
    const GizmoGrip grip = grip_of(editor.state(), editor.selected, editor.active(), pivot, settings_.local_axes);
    if (in.over && !grip.held.empty() && !in.held) hovered_ = pick(picture_of(in), grip, {in.x, in.y});
    if (in.pressed && !in.alt) {
      hovered_ = pick(picture_of(in), grip, {in.x, in.y});
      if (hovered_ != GizmoPart::kNone) {
        begin(editor, hovered_, in);
        dragging_ = true;
        return true;
      }
    }
    const std::size_t axis = in.typed.find_first_of("xyz");
    if (axis == std::string::npos || grip.held.empty() || in.control || in.held) return false;
    begin(editor, static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + (in.typed[axis] - 'x')), in);
    typing_ = true;
    text_ = in.typed.substr(axis, 1);
    return true;
  }
  if (in.escape) {
    finish(editor, false);
    return true;
  }
  take_text(editor, in);
  if (in.enter && (text_.empty() || understood_)) {
    finish(editor, true);
    return true;
  }
  if (dragging_ && !typing_ && (in.dx != 0 || in.dy != 0 || in.released)) {
    if (const auto amounts = dragged(editor, in, settings_.snap != in.control)) {
      amounts_ = *amounts;
      any_ = true;
      show(editor);
    }
    last_ = {in.x, in.y};
  }
  if (dragging_ && !in.held) {
    dragging_ = false;
    if (!typing_) finish(editor, true);
  }
  return true;
}

void GizmoTool::begin(Editor& editor, GizmoPart part, const ViewportInput& in) {
  grip_ = grip_of(editor.state(), editor.selected, editor.active(), pivot, settings_.local_axes);
  part_ = part;
  from_ = last_ = {in.x, in.y};
  any_ = false;
  text_.clear();
  understood_ = true;
  gesture_ = std::string(name()) + " " + std::to_string(++gestures_);
  begun(editor);
}

void GizmoTool::show(Editor& editor) {
  if (any_) editor.apply(name(), placed(editor.state(), placings(amounts_)), gesture_);
}

void GizmoTool::finish(Editor& editor, bool keep) {
  const auto stays = [&] {
    const std::vector<Placing> to = any_ ? placings(amounts_) : std::vector<Placing>{};
    return std::equal(to.begin(), to.end(), grip_.held.begin(), [](const Placing& a, const GizmoGrip::Held& b) {
      return a.local.translation == b.local.translation && a.local.rotation == b.local.rotation &&
             a.local.scale == b.local.scale;
    });
  };
  if (!keep || stays()) editor.drop_gesture(gesture_);
  editor.document.end_gesture();
  dragging_ = typing_ = false;
  part_ = GizmoPart::kNone;
  text_.clear();
}

void GizmoTool::leave(Editor& editor) {
  if (dragging_ || typing_) finish(editor, understood_ || text_.empty());
}

void GizmoTool::take_text(Editor& editor, const ViewportInput& in) {
  if (in.typed.empty() && !in.erase) return;
  for (const char c : in.typed)
    if (c >= ' ' && c < 127 && text_.size() < 200) {
      if (c >= 'x' && c <= 'z') {  // replaces the previous axis
        std::erase_if(text_, [](char t) { return t >= 'x' && t <= 'z'; });
        text_.insert(text_.begin(), c);
      } else {
        text_ += c;
      }
    }
  if (in.erase && !text_.empty()) text_.pop_back();
  typing_ = true;
  const TypedValue typed = typed_value(text_, lengths() ? "m" : snap_unit());
  understood_ = typed.understood;
  if (typed.axis != GizmoPart::kNone) part_ = typed.axis;
  if (typed.understood) {
    amounts_ = typed_amounts(part_, typed.value.value_or(lengths() || snap_unit()[0] != '\0' ? 0.0 : 1.0));
    any_ = true;
    show(editor);
  }
}

void GizmoTool::overlay(Editor& editor, const ViewportInput& in, ImDrawList& list) {
  if (editor.selected.empty()) return;
  const GizmoPicture picture = picture_of(in);
  const bool busy = dragging_ || typing_;
  const GizmoGrip grip = grip_of(editor.state(), editor.selected, editor.active(), pivot, settings_.local_axes);
  if (grip.held.empty()) return;
  GizmoGrip shown = grip;
  if (busy) {
    shown.axes = grip_.axes;
    // Keep the pivot fixed: bounds change a little during rotation.
    dvec3 by(0);
    for (std::size_t i = 0; i < std::min(grip.held.size(), grip_.held.size()); ++i)
      by += (grip.held[i].place - grip_.held[i].place) / static_cast<double>(grip.held.size());
    shown.pivot = lengths() ? grip_.pivot + by : grip_.pivot;
  }
  const auto middle = picture.pixel(shown.pivot);
  if (!middle || !gizmo::unit(picture, shown)) return;
  const ui::Palette& p = ui::palette();
  if (busy && (is_axis(part_) || is_plane(part_))) {
    // The axes of the motion, across the picture.
    for (int i = 0; i < 3; ++i) {
      if (is_axis(part_) ? i != axis_of(part_) : i == axis_of(part_)) continue;
      const auto size = gizmo::unit(picture, shown);
      const auto a = picture.pixel(shown.pivot - 40.0 * *size * shown.axes[i]),
                 b = picture.pixel(shown.pivot + 40.0 * *size * shown.axes[i]);
      if (!a || !b) continue;
      dvec2 way(b->x - a->x, b->y - a->y);
      if (length(way) < 1.0) continue;
      way = 4000.0 * glm::normalize(way);
      list.AddLine(
          {in.corner.x + static_cast<float>(middle->x - way.x), in.corner.y + static_cast<float>(middle->y - way.y)},
          {in.corner.x + static_cast<float>(middle->x + way.x), in.corner.y + static_cast<float>(middle->y + way.y)},
          ui::color(p.axis[i], 0.45f), ui::px(1));
    }
  }
  draw(picture, shown, in.corner, list, busy ? part_ : hovered_);
  const std::string scope = "Gizmo/";
  const float reach = ui::px(gizmo::kReach);
  if (!busy)
    for (int i = 0; i < 3; ++i) {
      const auto end = picture.pixel(shown.pivot + 0.75 * static_cast<double>(gizmo::kLength) *
                                                       *gizmo::unit(picture, shown) * shown.axes[i]);
      if (!end) continue;
      const ImVec2 at(in.corner.x + static_cast<float>(end->x), in.corner.y + static_cast<float>(end->y));
      ui::known_at(scope + "xyz" [i], { at.x - reach, at.y - reach }, {at.x + reach, at.y + reach});
    }
  const ImVec2 at(in.corner.x + static_cast<float>(middle->x), in.corner.y + static_cast<float>(middle->y));
  ui::known_at(scope + "middle", {at.x - reach, at.y - reach}, {at.x + reach, at.y + reach});
  if (!busy) return;
  // The current amount, beside the mouse.
  std::string text = typing_ ? text_ + "\u258f" : std::string();
  const std::string said = any_ ? readout(amounts_) : std::string();
  if (typing_ && !understood_)
    text += lengths() ? "   a length: 5 mm, 1/10, x -2 cm" : "   a number: 45, 1/3, x -2";
  else if (!said.empty())
    text += (text.empty() ? "" : "   ") + said;
  if (typing_) text += "   Enter keeps it, Esc leaves it";
  if (text.empty()) return;
  ImGui::PushFont(ui::font(ui::Type::kStrong));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float pad = ui::px(ui::kSpace);
  ImVec2 low(at.x + ui::px(24), at.y + ui::px(24));
  low.x = std::clamp(low.x, in.corner.x + pad,
                     std::max(in.corner.x + pad, in.corner.x + static_cast<float>(in.width) - size.x - 3 * pad));
  low.y = std::clamp(low.y, in.corner.y + pad,
                     std::max(in.corner.y + pad, in.corner.y + static_cast<float>(in.height) - size.y - 3 * pad));
  list.AddRectFilled(low, {low.x + size.x + 2 * pad, low.y + size.y + pad}, ui::color(p.raised, 0.94f), ui::px(4));
  list.AddText({low.x + pad, low.y + 0.5f * pad}, ui::color(understood_ ? p.text : p.bad), text.c_str());
  ImGui::PopFont();
}

void GizmoTool::options(Editor& editor) {
  ui::checkbox("Snap", settings_.snap, "Moves in steps of this size. Ctrl while dragging turns it round.");
  ui::beside(ui::kSpace, "", 70);
  ui::number("Step", snap_step(), lengths() ? 1e-9 : 1e-3, lengths() ? 1e3 : 360, snap_unit(), true, 78);
  ui::hint("The size of a step");
  ui::beside(ui::kPad, "WorldLocal", 20);
  if (ui::choice_button("World", !settings_.local_axes, "Along the axes of the world")) settings_.local_axes = false;
  ImGui::SameLine(0, ui::px(2));
  if (ui::choice_button("Local", settings_.local_axes, "Along the own axes of the node that was selected last"))
    settings_.local_axes = true;
  ui::beside(ui::kPad, "MiddleOrigin", 20);
  if (ui::choice_button("Middle", pivot == Pivot::kMiddle, "About the middle of what is selected"))
    pivot = Pivot::kMiddle;
  ImGui::SameLine(0, ui::px(2));
  if (ui::choice_button("Origin", pivot == Pivot::kOrigin,
                        "About the node's origin; of several nodes, the mean of their origins"))
    pivot = Pivot::kOrigin;
  more_options(editor);
}

}  // namespace pliant
