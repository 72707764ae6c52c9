// The viewport: its picture, its mouse, and the order for the next picture.
#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/app/fixed_window.h"
#include "editor/app/navigation.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kZoomClicks = 20.0;  // of the wheel, by a drag over the whole height
constexpr float kClick = 4;           // [point] a press that moves farther is a drag

vec4 as_vec(const ImVec4& c, float alpha = 1.0f) {
  return {c.x, c.y, c.z, alpha};
}

}  // namespace

// Mouse and keys of this frame, in the viewport.
ViewportInput App::viewport_input(ImVec2 low, ImVec2 high, double dt) {
  const ImGuiIO& io = ImGui::GetIO();
  ViewportInput in;
  in.corner = low;
  in.x = static_cast<double>(io.MousePos.x - low.x);
  in.y = static_cast<double>(io.MousePos.y - low.y);
  in.dx = static_cast<double>(io.MouseDelta.x);
  in.dy = static_cast<double>(io.MouseDelta.y);
  in.width = std::max(1, static_cast<int>(high.x - low.x));
  in.height = std::max(1, static_cast<int>(high.y - low.y));
  in.over = ImGui::IsItemHovered();
  in.pressed = in.over && ImGui::IsMouseClicked(0);
  if (in.pressed) pressed_in_view_ = true;
  in.held = pressed_in_view_ && ImGui::IsMouseDown(0);
  in.released = pressed_in_view_ && ImGui::IsMouseReleased(0);
  in.shift = io.KeyShift;
  in.control = io.KeyCtrl;
  in.alt = io.KeyAlt;
  // Input refers to the displayed picture, though the camera may be ahead of it.
  in.view = picture_.number > 0 ? picture_.view : editor.camera.viewpoint();
  in.orthographic = picture_.number > 0 ? picture_.orthographic : orthographic();
  if (!io.WantTextInput) {
    for (const ImWchar c : io.InputQueueCharacters)
      if (c >= 32 && c < 127) in.typed += static_cast<char>(c);
    const auto key = [](ImGuiKey_ k) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(k)); };
    in.enter = key(ImGuiKey_Enter) || key(ImGuiKey_KeyPadEnter);
    in.escape = key(ImGuiKey_Escape) && !popup_was_open_;
    in.erase = key(ImGuiKey_Backspace);
  }
  in.under = picture_.picked.node;
  in.under_at = picture_.picked.point;
  in.dt = dt;
  if (in.pressed) {
    pressed_at_ = io.MousePos;
    moved_since_press_ = false;
  }
  const ImVec2 away(io.MousePos.x - pressed_at_.x, io.MousePos.y - pressed_at_.y);
  if (std::hypot(away.x, away.y) > ui::px(kClick)) moved_since_press_ = true;
  return in;
}

// Input goes to the tool first, then to the camera, then to selection. True: the tool has used it.
bool App::offer_to_tool(const ViewportInput& in) {
  if (in.alt) return false;
  if (play_.on() && touch(in)) return true;
  ViewTool* const t = tool();
  return t && t->usable(editor) && t->use(editor, in);
}

void App::move_camera(const ViewportInput& in, bool active, bool taken) {
  ViewDrag drag;
  drag.left = active && !taken && ImGui::IsMouseDragging(0, 1.0f) && (in.alt || in.shift || moved_since_press_);
  drag.right = active && ImGui::IsMouseDragging(1, 1.0f);
  drag.middle = active && ImGui::IsMouseDragging(2, 1.0f);
  drag.shift = in.shift, drag.control = in.control, drag.alt = in.alt;
  const ViewMotion motion = view_motion(settings.navigation, drag);
  dragging_view_ = motion != ViewMotion::kNone;
  if (motion == ViewMotion::kShift) editor.camera.pan(in.dx, in.dy, in.height);
  if (motion == ViewMotion::kTurn) editor.camera.orbit(in.dx, in.dy, in.height);
  if (motion == ViewMotion::kZoom) editor.camera.zoom(-kZoomClicks * in.dy / in.height);
  const float wheel = ImGui::GetIO().MouseWheel;
  if (in.over && wheel != 0 && !taken) editor.camera.zoom(static_cast<double>(wheel));
}

// The next picture says which object is under the mouse; a click selects it.
void App::pick(const ViewportInput& in, bool taken) {
  if (in.released && !taken && !moved_since_press_) {
    asked_ = dvec2(in.x, in.y);
    selects_ = ++question_;
    select_adds_ = in.shift || in.control;
    dirty_picture_ = true;
  } else if (!play_.on() && in.over && (wants_question_ || in.dx != 0 || in.dy != 0)) {
    wants_question_ = dragging_view_ || taken || stage_->busy();
    if (!wants_question_) {
      asked_ = dvec2(in.x, in.y);
      ++question_;
      dirty_picture_ = true;
    }
  }
  if (in.released) pressed_in_view_ = false;
  if (selects_ && picture_.question >= *selects_) {
    editor.select(picture_.picked.node, select_adds_);
    selects_.reset();
    dirty_picture_ = true;
  }
  if (in.over) editor.hovered = !dragging_view_ && !taken ? picture_.picked.node : kNoNode;
  if (taken && (in.dx != 0 || in.dy != 0 || in.pressed || in.released)) dirty_picture_ = true;
}

void App::draw_viewport(ImVec2 low, ImVec2 high, double dt) {
  viewport_low_ = low;
  viewport_high_ = high;
  if (editor.state().nodes.empty() && editor.document.file().empty()) {
    dragging_view_ = pressed_in_view_ = false;
    return draw_start(low, high);
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  begin_fixed("viewport", low, high,
              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground |
                  ImGuiWindowFlags_NoNavInputs);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (picture_.texture != 0)
    list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture_.texture)), low, high, {0, 1},
                  {1, 0});
  ImGui::SetCursorScreenPos(low);
  ImGui::InvisibleButton(
      "Viewport", {high.x - low.x, high.y - low.y},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  ui::known_as("Viewport");
  const bool active = ImGui::IsItemActive();
  const ViewportInput in = viewport_input(low, high, dt);
  const bool taken = offer_to_tool(in);
  move_camera(in, active, taken);
  pick(in, taken);
  list.PushClipRect(low, high, true);
  if (ViewTool* t = tool()) t->overlay(editor, in, list);
  ViewBar::draw_over(editor, in, list);
  draw_play_over(list, low, high);
  if (!picture_.trouble.empty())
    list.AddText({low.x + ui::px(ui::kPad), high.y - ui::px(28)}, ui::color(ui::palette().bad),
                 picture_.trouble.c_str());
  list.PopClipRect();
  ImGui::End();
  view_bar_.draw(editor, tool(), low, high);
}

void App::draw_start(ImVec2 low, ImVec2 high) {
  Panel* const page = panel("Start");
  if (!page) return;
  begin_fixed("start", low, high);
  {
    const ui::Scope scope("Start");
    page->draw(editor);
  }
  ImGui::End();
}

// The look of the document, from the viewport's camera.
SolidOrder App::look_of_document() const {
  const ui::Palette& p = ui::palette();
  SolidOrder solid;
  solid.view = editor.camera.viewpoint();
  solid.settings = editor.view;
  solid.above = as_vec(p.raised);
  solid.below = as_vec(p.window);
  solid.grid = as_vec(p.text, 0.16f);
  solid.selected_color = as_vec(p.accent);
  solid.hovered_color = as_vec(p.text, 0.55f);
  for (int i = 0; i < 3; ++i) solid.axis[i] = as_vec(p.axis[i]);
  solid.sign = as_vec(p.dim, 0.9f);
  return solid;
}

StageOrder App::plain_order(const Viewpoint& view, int width, int height) {
  StageOrder order;
  order.width = width;
  order.height = height;
  order.solid = look_of_document();
  order.solid.view = view;
  order.solid.settings.grid = order.solid.settings.nodes = order.solid.settings.names = false;
  order.solid.settings.regions = order.solid.settings.normals = false;
  order.solid.state = editor.state();
  return order;
}

void App::order_picture() {
  SolidOrder solid = look_of_document();
  solid.orthographic = orthographic();
  solid.selected = editor.selected;
  solid.hovered = editor.hovered;
  solid.lines = extra_lines;
  if (ViewTool* t = tool()) t->lines(editor, solid.lines);
  if (editor.view.creases) {
    creases_.update(editor);
    solid.creases = creases_.known();
  }
  guides_.update(editor);
  solid.guides = guides_.known();
  const bool another =
      !same_scene(solid, ordered_) || solid.hovered != ordered_.hovered || ordered_size_ != viewport_size_now();
  if (!dirty_picture_ && !another && order_ > 0) return;
  dirty_picture_ = false;
  ordered_ = solid;
  lines_ = solid.lines;
  ordered_size_ = viewport_size_now();
  StageOrder order;
  order.width = ordered_size_.first;
  order.height = ordered_size_.second;
  order.solid = std::move(solid);
  order.solid.state = editor.state();
  if (asked_) {
    order.question = asked_;
    order.question_number = question_;
    asked_.reset();
  }
  order_ = stage_->order(std::move(order));
}

std::pair<int, int> App::viewport_size_now() const {
  return {std::max(1, static_cast<int>(viewport_high_.x - viewport_low_.x)),
          std::max(1, static_cast<int>(viewport_high_.y - viewport_low_.y))};
}

}  // namespace pliant
