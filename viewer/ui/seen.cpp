#include "viewer/ui/seen.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace pliant::ui {
namespace {

ImGuiWindow* window_of(const Place& place) {
  return ImGui::FindWindowByID(place.window);
}

// A name for the user: from its content.
std::string name_of(const ImGuiWindow* window) {
  for (const Place& each : widgets()) {
    const ImGuiWindow* const its = window_of(each);
    if (its && (its == window || its->RootWindow == window->RootWindow))
      return each.address.substr(0, each.address.find('/'));
  }
  const std::string name = window->Name;
  return name.substr(0, name.find_first_of("#/"));
}

// The front window at a pixel; tooltips do not count.
ImGuiWindow* front_at(float x, float y) {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  for (int i = g.Windows.Size - 1; i >= 0; --i) {
    ImGuiWindow* const window = g.Windows[i];
    if (!window->Active || window->Hidden || (window->Flags & ImGuiWindowFlags_Tooltip)) continue;
    if (window->OuterRectClipped.Contains(ImVec2(x, y))) return window;
  }
  return nullptr;
}

// The open popup above it, if any: a press closes that and does nothing else.
const ImGuiWindow* popup_over(const ImGuiWindow* window) {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  const ImGuiWindow* open = nullptr;
  for (int i = 0; i < g.OpenPopupStack.Size; ++i) {
    const ImGuiWindow* const popup = g.OpenPopupStack[i].Window;
    if (!popup || !popup->Active) continue;
    if (popup == window->RootWindow)
      open = nullptr;
    else
      open = popup;
  }
  return open;
}

bool inside(float at, float low, float high) {
  return at >= low - 0.5f && at <= high + 0.5f;
}

}  // namespace

std::string why_unseen(const Place& place, float x, float y) {
  if (place.high.x - place.low.x < 1.0f || place.high.y - place.low.y < 1.0f)
    return fmt::format("'{}' has no size", place.address);
  if (place.window == 0) return {};
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  if (!inside(x, place.seen_low.x, place.seen_high.x) || !inside(y, place.seen_low.y, place.seen_high.y))
    return fmt::format("'{}' is scrolled out of sight; turn the wheel over its panel first", place.address);
  if (x < 0 || y < 0 || x >= display.x || y >= display.y)
    return fmt::format("'{}' is outside of the window", place.address);
  const ImGuiWindow* const front = front_at(x, y);
  if (!front || front->ID == place.window) return {};
  return fmt::format("'{}' is covered by {} at {:.0f}, {:.0f}", place.address, name_of(front), x, y);
}

std::string why_unpressable(const Place& place, float x, float y) {
  if (std::string why = why_unseen(place, x, y); !why.empty()) return why;
  if (!place.enabled) return fmt::format("'{}' is off", place.address);
  const ImGuiWindow* const window = place.window == 0 ? nullptr : window_of(place);
  if (!window || place.through_popups) return {};
  if (const ImGuiWindow* const popup = popup_over(window))
    return fmt::format("'{}' is behind {}, which is open; answer it or close it with Esc first", place.address,
                       name_of(popup));
  return {};
}

std::string shared_identity() {
  std::vector<const Place*> all;
  for (const Place& each : widgets())
    if (each.id != 0) all.push_back(&each);
  std::stable_sort(all.begin(), all.end(), [](const Place* a, const Place* b) { return a->id < b->id; });
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Place &a = *all[i - 1], &b = *all[i];
    // One item may have two addresses.
    if (a.id == b.id && (a.low.x != b.low.x || a.low.y != b.low.y || a.window != b.window))
      return fmt::format("'{}' and '{}' have one identity: only one of them answers", a.address, b.address);
  }
  return {};
}

std::string not_apart() {
  constexpr float kSlack = 2.0f, kCut = 12.0f;  // [pixel] tolerance at borders; for rows that extend beyond their list
  struct Shown {
    const Place* place;
    ImRect full, seen;
  };
  std::vector<Shown> all;
  for (const Place& each : widgets()) {
    const ImGuiWindow* const window = each.id != 0 ? window_of(each) : nullptr;
    if (!window) continue;
    Shown shown{&each, ImRect(each.low, each.high), ImRect(each.seen_low, each.seen_high)};
    ImRect display(ImVec2(0, 0), ImGui::GetIO().DisplaySize);
    shown.seen.ClipWith(display);
    bool scrolls_x = false, scrolls_y = false;
    for (const ImGuiWindow* w = window; w; w = w->ParentWindow) {
      scrolls_x |= w->ScrollMax.x > 0 && (w->Flags & ImGuiWindowFlags_HorizontalScrollbar) != 0;
      scrolls_y |= w->ScrollMax.y > 0;
    }
    const bool cut_x = shown.seen.GetWidth() + kCut < shown.full.GetWidth(),
               cut_y = shown.seen.GetHeight() + kCut < shown.full.GetHeight();
    if ((cut_x && !scrolls_x) || (cut_y && !scrolls_y))
      return fmt::format("'{}' is cut off: {:.0f} by {:.0f} pixels are seen of {:.0f} by {:.0f}", each.address,
                         std::max(shown.seen.GetWidth(), 0.0f), std::max(shown.seen.GetHeight(), 0.0f),
                         shown.full.GetWidth(), shown.full.GetHeight());
    if (shown.seen.GetWidth() < kSlack || shown.seen.GetHeight() < kSlack) continue;  // scrolled out
    const ImVec2 middle = shown.seen.GetCenter();
    if (std::string why = why_unseen(each, middle.x, middle.y); !why.empty()) return why;
    all.push_back(shown);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (all[i].place->window != all[k].place->window || all[i].place->id == all[k].place->id) continue;
      ImRect both = all[i].seen;
      both.ClipWithFull(all[k].seen);
      const bool inside = all[i].full.Contains(all[k].full) || all[k].full.Contains(all[i].full);
      if (!inside && both.Overlaps(all[k].seen) && both.GetWidth() > kSlack && both.GetHeight() > kSlack)
        return fmt::format("'{}' and '{}' overlap", all[k].place->address, all[i].place->address);
    }
  return {};
}

void focus_next(bool back) {
  ImGuiContext& g = *ImGui::GetCurrentContext();
  // A question, a menu or a dialog takes all keys.
  const ImGuiWindow* only = g.OpenPopupStack.Size > 0 ? g.OpenPopupStack.back().Window : nullptr;
  if (!only && g.NavWindow && (g.NavWindow->RootWindow->Flags & ImGuiWindowFlags_NoBringToFrontOnFocus) == 0)
    only = g.NavWindow->RootWindow;
  std::vector<const Place*> order;
  for (const Place& each : widgets()) {
    ImGuiWindow* const window = window_of(each);
    if (each.id == 0 || !each.enabled || !window || !window->WasActive) continue;
    if (only && window->RootWindow != only) continue;
    if (!order.empty() && order.back()->id == each.id) continue;  // two addresses
    // A list with arrow key selection is one Tab stop.
    const bool list = (window->Flags & ImGuiWindowFlags_NoNavInputs) != 0;
    if (list && std::any_of(order.begin(), order.end(), [&](const Place* p) { return p->window == each.window; }))
      continue;
    order.push_back(&each);
  }
  if (order.empty()) return;
  const ImGuiID now = g.ActiveId != 0 ? g.ActiveId : g.NavId;
  auto at = std::find_if(order.begin(), order.end(), [&](const Place* p) { return p->id == now && now != 0; });
  if (at == order.end() && g.NavWindow)
    at = std::find_if(order.begin(), order.end(), [&](const Place* p) { return p->window == g.NavWindow->ID; });
  const auto count = static_cast<std::ptrdiff_t>(order.size());
  const std::ptrdiff_t i =
      at == order.end() ? (back ? count - 1 : 0) : (at - order.begin() + (back ? count - 1 : 1)) % count;
  const Place& to = *order[static_cast<std::size_t>(i)];
  ImGuiWindow* const window = window_of(to);
  ImGui::ClearActiveID();
  ImGui::FocusWindow(window);
  const ImRect rect(to.low, to.high);
  ImGui::SetNavID(
      to.id, ImGuiNavLayer_Main, 0,
      ImRect(to.low.x - window->Pos.x, to.low.y - window->Pos.y, to.high.x - window->Pos.x, to.high.y - window->Pos.y));
  ImGui::ScrollToBringRectIntoView(window, rect);
  g.NavDisableHighlight = false;
  g.NavDisableMouseHover = true;
  if (!to.takes_text) return;
  g.NavNextActivateId = to.id;
  g.NavNextActivateFlags = ImGuiActivateFlags_PreferInput;
}

bool keyboard_has_focus() {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  return g.NavId != 0 && !g.NavDisableHighlight && g.NavWindow &&
         (g.NavWindow->Flags & ImGuiWindowFlags_NoNavInputs) == 0;
}

bool keyboard_is_on_field() {
  const ImGuiID now = ImGui::GetCurrentContext()->NavId;
  return std::any_of(widgets().begin(), widgets().end(),
                     [&](const Place& each) { return each.id == now && each.takes_text; });
}

void lead_by_keyboard() {
  ImGuiContext& g = *ImGui::GetCurrentContext();
  g.NavDisableHighlight = false;
}

bool popup_is_open() {
  return ImGui::GetCurrentContext()->OpenPopupStack.Size > 0;
}

}  // namespace pliant::ui
