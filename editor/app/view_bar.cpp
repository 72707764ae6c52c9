#include "editor/app/view_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "editor/viewport/frames.h"
#include "editor/viewport/gizmo_math.h"
#include "editor/viewport/signs.h"
#include "plot/heat.h"
#include "runtime/printable.h"
#include "viewer/ui/imgui_pen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kCross = 34, kEnd = 9.5f;  // [point] half its size; radius of an end
constexpr std::size_t kMostNames = 300;
constexpr const char* kPaintTool = "Paint";  // it has its own legend

bool begin_over(const char* name, ImVec2 at, ImVec2 pivot, bool plain = false) {
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImVec4 back = ui::palette().raised;
  back.w = plain ? 0.0f : 0.94f;
  ImGui::PushStyleColor(ImGuiCol_WindowBg, back);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui::px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, plain ? ImVec2(0, 0) : ImVec2(ui::px(6), ui::px(5)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  const bool open = ImGui::Begin(name, nullptr,
                                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNavFocus);
  ImGui::PopStyleVar(3);
  ImGui::PopStyleColor();
  return open;
}

std::string capital(std::string word) {
  if (!word.empty()) word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

void text_at(ImDrawList& list, ImVec2 at, ImU32 color, const std::string& text, ui::Type type = ui::Type::kSmall) {
  ImFont* const font = ui::font(type);
  list.AddText(font, font->FontSize, at, color, text.c_str());
}
ImVec2 size_of(const std::string& text, ui::Type type = ui::Type::kSmall) {
  ImFont* const font = ui::font(type);
  return font->CalcTextSizeA(font->FontSize, 1e6f, 0, text.c_str());
}

void draw_legend(const ViewSettings& view, const ViewportInput& in, ImDrawList& list) {
  const ui::Palette& p = ui::palette();
  const bool share = is_share(*view.channel);
  const std::string title = capital(name_of(*view.channel)) + (share ? ", share" : ", factor");
  const float wide = ui::px(168), high = ui::px(10), pad = ui::px(8), line = ui::px(16);
  const ImVec2 low(in.corner.x + static_cast<float>(in.width) - wide - 3 * pad,
                   in.corner.y + static_cast<float>(in.height) - 2 * line - high - 3 * pad);
  list.AddRectFilled({low.x - pad, low.y - pad}, {low.x + wide + pad, low.y + 2 * line + high + pad},
                     ui::color(p.raised, 0.94f), ui::px(6));
  text_at(list, low, ui::color(p.text), title);
  const float top = low.y + line + ui::px(2);
  ui::ImGuiPen pen(list, {});
  draw_color_bar(pen, {low.x, top, wide, high}, false, heat);
  const double first = share ? 0.0 : view.value_low, last = share ? 1.0 : view.value_high;
  const auto mark = [&](double value, float t) {
    const std::string text = fmt::format("{:.3g}", value);
    const float w = size_of(text).x;
    text_at(list, {std::clamp(low.x + t * wide - 0.5f * w, low.x, low.x + wide - w), top + high + ui::px(1)},
            ui::color(p.dim), text);
  };
  mark(first, 0);
  mark(last, 1);
  if (share)
    mark(0.5, 0.5f);
  else if (first < 1.0 && last > 1.0)
    mark(1.0, static_cast<float>(std::log(1.0 / first) / std::log(last / first)));
}

void draw_names(const Editor& editor, const ViewportInput& in, ImDrawList& list) {
  const State& state = editor.state();
  const std::vector<dmat4> frames = world_frames(state);
  const std::vector<bool> shown = shown_nodes(state, editor.view.isolated);
  const ui::Palette& p = ui::palette();
  std::size_t count = 0;
  for (std::size_t i = 0; i < frames.size() && count < kMostNames; ++i) {
    if (!shown[i]) continue;
    const LevelNode& node = state.nodes[i]->node;
    dvec3 place(frames[i][3]);
    if (const Box box = bounds_of(state, i, frames[i]); !box.empty()) place = dvec3(box.center());
    const auto at = on_picture(in.view, in.orthographic, in.width, in.height, place);
    if (!at || at->x < 0 || at->y < 0 || at->x > in.width || at->y > in.height) continue;
    ++count;
    const std::string text = printable(node.name);
    const ImVec2 size = size_of(text);
    const ImVec2 low(in.corner.x + static_cast<float>(at->x) + ui::px(10),
                     in.corner.y + static_cast<float>(at->y) - 0.5f * size.y);
    const bool selected = editor.is_selected(state.nodes[i]->id);
    list.AddRectFilled({low.x - ui::px(4), low.y - ui::px(1)}, {low.x + size.x + ui::px(4), low.y + size.y + ui::px(1)},
                       ui::color(p.raised, 0.95f), ui::px(3));
    text_at(list, low, ui::color(selected ? p.accent : p.text), text);
  }
}

}  // namespace

void ViewBar::draw_over(const Editor& editor, const ViewportInput& in, ImDrawList& list) {
  const ui::Palette& p = ui::palette();
  if (editor.view.names) draw_names(editor, in, list);
  if (editor.view.grid) {
    const std::string text = "Grid  " + metres_text(grid_step(in.view, in.orthographic));
    const ImVec2 at(in.corner.x + ui::px(ui::kPad), in.corner.y + static_cast<float>(in.height) - ui::px(26));
    const ImVec2 size = size_of(text), around(ui::px(ui::kGap), ui::px(2));
    list.AddRectFilled({at.x - around.x, at.y - around.y}, {at.x + size.x + around.x, at.y + size.y + around.y},
                       ui::color(p.panel, 0.95f), ui::px(4));  // readable over any picture
    text_at(list, at, ui::color(p.dim), text);
  }
  if (editor.view.channel && editor.view.shading == Shading::kSolid && editor.tool != kPaintTool)
    draw_legend(editor.view, in, list);
}

void ViewBar::draw(Editor& editor, ViewTool* tool, ImVec2 low, ImVec2 high) {
  const float pad = ui::px(ui::kSpace);
  float top = low.y + pad;
  if (tool && tool->has_options() && tool->usable(editor)) {
    if (begin_over("tool options", {low.x + pad, top}, {0, 0})) {
      const ui::Scope scope(tool->name());
      // Overlays and axis cross are beside it.
      ui::rows_end_at(high.x - 2 * pad -
                      std::max(ImGui::CalcTextSize("Overlays  \u25be").x + ui::px(2 * ui::kSpace + 12),
                               2 * ui::px(kCross + kEnd + 2)));
      tool->options(editor);
      ui::rows_end_at(0);
    }
    top += ImGui::GetWindowHeight() + ui::px(ui::kGap);
    ImGui::End();
  }
  if (!editor.view.isolated.empty() || editor.view.clip.on) {
    if (begin_over("view state", {low.x + pad, top}, {0, 0})) {
      const ui::Scope scope("View state");
      if (!editor.view.isolated.empty()) {
        ui::label(fmt::format("Isolated: {}", editor.view.isolated.size()).c_str(), "Only these are shown.");
        ImGui::SameLine();
        if (ui::button("Show all", "Shows every node again (I)")) editor.view.isolated.clear();
      }
      if (editor.view.clip.on) {
        if (!editor.view.isolated.empty()) ImGui::SameLine(0, ui::px(ui::kPad));
        ui::label("Clipped", "A plane cuts the picture open; the level stays whole.");
        ImGui::SameLine();
        if (ui::button("Unclip", "Shows what is cut away again")) editor.view.clip.on = false;
      }
    }
    ImGui::End();
  }
  if (begin_over("overlays", {high.x - pad, low.y + pad}, {1, 0})) {
    const ui::Scope scope("View");
    if (ui::button("Overlays  \u25be", "What is drawn over the level, and where it is cut open"))
      ImGui::OpenPopup("overlays list");
    ui::known_as("Overlays");
    const ImVec2 at(ImGui::GetWindowPos().x + ImGui::GetWindowWidth(),
                    ImGui::GetWindowPos().y + ImGui::GetWindowHeight() + ui::px(ui::kGap));
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, {1, 0});
    if (ImGui::BeginPopup("overlays list")) {
      {
        const ui::Scope inner("Overlays");
        draw_overlays(editor);
      }
      ImGui::EndPopup();
    }
  }
  const float below = ImGui::GetWindowPos().y + ImGui::GetWindowHeight();
  ImGui::End();
  if (high.y - below > ui::px(150)) {
    if (begin_over("cross", {high.x - pad, below + ui::px(ui::kGap)}, {1, 0}, true)) {
      const ui::Scope scope("View");
      draw_cross(editor);
    }
    ImGui::End();
  }
}

void ViewBar::draw_overlays(Editor& editor) {
  ViewSettings& view = editor.view;
  const bool solid = view.shading == Shading::kSolid;
  const float column = ui::px(136);
  const auto pair = [&] { ImGui::SameLine(column); };
  ui::label("Surfaces");
  ui::checkbox("Wireframe", view.wireframe, "The edges of all triangles (W)");
  pair();
  ui::checkbox("Normals", view.normals, "A short line along the normal of every vertex, or of every few (N)");
  ui::checkbox("Creases", view.creases,
               "Edges over which the surface turns sharply: paint may stop there, and touch feels them");
  pair();
  ui::checkbox("Zones", view.zones, "Rendered only: the patches of vertices that are computed together");
  ui::checkbox("Tetrahedra", view.tetrahedra,
               "The inside of a soft body, by quality, where one has been built or previewed");
  ui::gap();
  ui::label("Painted values", "What is painted on the meshes, as colour. Solid view only.");
  pair();
  std::string shown = view.channel ? name_of(*view.channel) : "none";
  std::vector<std::string> choices{"none"};
  for (const Channel channel : kChannels) choices.push_back(name_of(channel));
  if (ui::combo("Channel", shown, choices, 128)) {
    view.channel.reset();
    for (const Channel channel : kChannels)
      if (shown == name_of(channel)) view.channel = channel;
    if (view.channel && !solid) view.shading = Shading::kSolid;
  }
  if (view.channel && !is_share(*view.channel)) {
    ui::label("Colours from", "The factors at the ends of the colours");
    pair();
    if (ui::number("Lowest value", view.value_low, 1e-4, 1e4, "", true, 60))
      view.value_low = std::min(view.value_low, 0.99 * view.value_high);
    ui::hint("The factor at the dark end");
    ImGui::SameLine(0, ui::px(ui::kSpace));
    if (ui::number("Highest value", view.value_high, 1e-4, 1e4, "", true, 60))
      view.value_high = std::max(view.value_high, 1.01 * view.value_low);
    ui::hint("The factor at the light end");
  }
  ui::gap();
  ui::label("Level");
  ui::checkbox("Grid", view.grid, "Lines a power of ten of a metre apart, on the floor y = 0 (G)");
  pair();
  ui::checkbox("Names", view.names, "The names of the nodes, beside them");
  ui::checkbox("Signs", view.nodes, "Probes, lights, cameras and haptic devices as lines; press one to select it");
  pair();
  ui::checkbox("Pins, handles", view.regions,
               "What holds a body fast (blue) or is its handle (yellow): boxes and painted dots");
  ui::gap();
  ui::label("While playing");
  ui::checkbox("Contacts", view.contacts, "Where probes and bodies touch");
  pair();
  ui::checkbox("Forces", view.forces, "Arrows of the forces on probes and bodies");
  ui::gap();
  draw_clip(editor);
  ui::gap();
  const bool isolates = !view.isolated.empty();
  if (ui::button(isolates ? "Show all" : "Isolate selected",
                 isolates                  ? "Shows every node again (I)"
                 : editor.selected.empty() ? "Select what is to be seen alone first."
                                           : "Only what is selected is shown (I)",
                 isolates || !editor.selected.empty()))
    view.isolated = isolates ? std::vector<NodeId>{} : editor.selected;
}

void ViewBar::draw_clip(Editor& editor) {
  ClipPlane& clip = editor.view.clip;
  ui::checkbox("Clip plane", clip.on, "Cuts the picture open; the level stays whole");
  ImGui::SameLine(ui::px(136));
  const char* const axes[] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) {
    if (i) ImGui::SameLine(0, ui::px(2));
    if (ui::choice_button(axes[i], clip.on && clip.axis == i, "Across this axis of the world")) {
      clip.axis = i;
      clip.on = true;
    }
  }
  ImGui::SameLine(0, ui::px(ui::kSpace));
  if (ui::choice_button("Flip", clip.flipped, "Cuts away the other side")) clip.flipped = !clip.flipped;
  if (ui::slider("Clip place", clip.place, 0.0, 1.0, "Where it cuts, from one end of the level to the other"))
    clip.on = true;
}

void ViewBar::draw_cross(Editor& editor) {
  struct End {
    const char* name;
    const char* hint;
    dvec3 along;
    double azimuth, elevation;
    int axis;
    bool positive;
  };
  constexpr double kRight = std::numbers::pi / 2;
  const End ends[] = {{"Right", "From the right, along -x (3)", {1, 0, 0}, kRight, 0, 0, true},
                      {"Left", "From the left, along +x (Ctrl+3)", {-1, 0, 0}, -kRight, 0, 0, false},
                      {"Top", "From above, along -y (7)", {0, 1, 0}, 0, kRight, 1, true},
                      {"Bottom", "From below, along +y (Ctrl+7)", {0, -1, 0}, 0, -kRight, 1, false},
                      {"Front", "From the front, along -z (1)", {0, 0, 1}, 0, 0, 2, true},
                      {"Back", "From behind, along +z (9)", {0, 0, -1}, 2 * kRight, 0, 2, false}};
  const ui::Palette& p = ui::palette();
  const Viewpoint view = editor.camera.viewpoint();
  const dvec3 forward = glm::normalize(view.target - view.eye), right = glm::normalize(cross(forward, view.up)),
              up = cross(right, forward);
  const float half = ui::px(kCross + kEnd + 2), end = ui::px(kEnd);
  const ImVec2 low = ImGui::GetCursorScreenPos(), middle(low.x + half, low.y + half);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool over = ImGui::IsWindowHovered() &&
                    std::hypot(ImGui::GetIO().MousePos.x - middle.x, ImGui::GetIO().MousePos.y - middle.y) < half;
  list.AddCircleFilled(middle, half, ui::color(over ? p.raised : p.panel, over ? 0.85f : 0.35f), 48);
  std::vector<const End*> order;
  for (const End& each : ends) order.push_back(&each);
  std::sort(order.begin(), order.end(),
            [&](const End* a, const End* b) { return dot(a->along, forward) > dot(b->along, forward); });
  const End* pressed = nullptr;
  for (const End* each : order) {
    const ImVec2 at(middle.x + ui::px(kCross) * static_cast<float>(dot(each->along, right)),
                    middle.y - ui::px(kCross) * static_cast<float>(dot(each->along, up)));
    ImGui::SetCursorScreenPos({at.x - end, at.y - end});
    ImGui::PushID(each->name);
    ImGui::SetItemAllowOverlap();
    if (ImGui::InvisibleButton("end", {2 * end, 2 * end})) pressed = each;
    ImGui::SetItemAllowOverlap();
    ImGui::PopID();
    ui::known_as(each->name);
    ui::hint(each->hint);
    const bool hot = ImGui::IsItemHovered();
    const ImVec4& color = p.axis[each->axis];
    const float behind = dot(each->along, forward) > 0.2 ? 0.55f : 1.0f;
    if (each->positive) {
      list.AddLine(middle, at, ui::color(color, behind), ui::px(2));
      list.AddCircleFilled(at, end, ui::color(hot ? p.text : color, hot ? 1.0f : behind), 24);
    } else {
      list.AddCircleFilled(at, end, ui::color(p.panel, 0.85f), 24);
      list.AddCircle(at, end - ui::px(0.5f), ui::color(hot ? p.text : color, behind), 24, ui::px(1.5f));
    }
    if (each->positive || hot) {
      const std::string text = std::string(each->positive ? "" : "-") + "xyz"[each->axis];
      const ImVec2 size = size_of(text);
      text_at(list, {at.x - 0.5f * size.x, at.y - 0.5f * size.y - ui::px(0.5f)},
              ui::color(each->positive ? p.window : p.text), text);
    }
  }
  // Pressed again, the end that faces the eye selects the opposite direction.
  if (pressed && dot(pressed->along, forward) < -0.999)
    pressed = std::find_if(std::begin(ends), std::end(ends), [&](const End& e) { return e.along == -pressed->along; });
  if (pressed) editor.camera.look_from(pressed->azimuth, pressed->elevation);
  const char* const name = editor.view.orthographic ? "Orthographic" : "Perspective";
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  const float wide = ImGui::CalcTextSize("Orthographic").x + ui::px(2 * ui::kSpace);
  ImGui::SetCursorScreenPos({middle.x + half - wide, low.y + 2 * half + ui::px(ui::kGap)});
  ImGui::PushStyleColor(ImGuiCol_Button, ui::palette().field);
  if (ui::button(fmt::format("{}###projection", name).c_str(),
                 "Changes between a picture with perspective and one without (5)", true, wide / ui::scale()))
    editor.view.orthographic = !editor.view.orthographic;
  ui::known_as("Projection");
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

}  // namespace pliant
