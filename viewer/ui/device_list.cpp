#include "viewer/ui/device_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant::ui {
namespace {

constexpr double kFresh = 0.1;               // [s]
constexpr double kUsualReach = 0.1;          // [m] if a device specifies no workspace
constexpr float kLabel = 62, kValue = 76;    // [point] columns
constexpr float kTrack = 6, kDial = 62;      // [point]
constexpr std::uint32_t kButtonsShown = 16;  // bits

bool renders(const DeviceCapabilities& can) {
  return can.renders_force || can.renders_torque || can.renders_grip || can.renders_vibration;
}
bool fresh(const DeviceReport& report) {
  return report.sample_age >= 0.0 && report.sample_age < kFresh;
}

const ImVec4& color_of(DeviceState state) {
  const Palette& p = palette();
  switch (state) {
    case DeviceState::kDisconnected:
    case DeviceState::kIdle:
      return p.dim;
    case DeviceState::kArmed:
      return p.warning;
    case DeviceState::kActive:
      return p.good;
    case DeviceState::kTripped:
      return p.bad;
  }
  return p.dim;
}

// A shape for each state, because colour alone is not enough: a broken ring, a ring, half a disc, a disc, an octagon.
void state_sign(DeviceState state) {
  const float side = ImGui::GetTextLineHeight(), r = std::round(0.4f * side);
  const ImVec2 low = ImGui::GetCursorScreenPos(), c(low.x + 0.5f * side, low.y + 0.5f * side);
  const ImU32 ink = color(color_of(state));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr float kTurn = 6.2831853f;
  switch (state) {
    case DeviceState::kDisconnected:
      for (int i = 0; i < 4; ++i) {
        const float from = kTurn * (static_cast<float>(i) + 0.15f) / 4, to = kTurn * (static_cast<float>(i) + 0.7f) / 4;
        list.PathArcTo(c, r, from, to, 8);
        list.PathStroke(ink, 0, px(1.75f));
      }
      break;
    case DeviceState::kIdle:
      list.AddCircle(c, r, ink, 24, px(1.75f));
      break;
    case DeviceState::kArmed:
      list.AddCircle(c, r, ink, 24, px(1.75f));
      list.PathArcTo(c, r, 0, 0.5f * kTurn, 16);
      list.PathFillConvex(ink);
      break;
    case DeviceState::kActive:
      list.AddCircleFilled(c, r, ink, 24);
      break;
    case DeviceState::kTripped:
      list.AddNgonFilled(c, r + px(1), ink, 8);
      list.AddLine({c.x, c.y - 0.55f * r}, {c.x, c.y + 0.15f * r}, color(palette().panel), px(2));
      list.AddCircleFilled({c.x, c.y + 0.55f * r}, px(1.25f), color(palette().panel), 8);
      break;
  }
  ImGui::Dummy({side, side});
}

struct Row {
  ImVec2 low, high;  // of its track
  float middle;
};

// Label at the left, value at the right, and space for a track between; `wide` 0: the available width.
Row row(const char* what, const std::string& value, float wide = 0, float label_wide = kLabel) {
  const Palette& p = palette();
  ImGui::PushFont(font(Type::kSmall));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (wide == 0) wide = ImGui::GetContentRegionAvail().x;
  const float high = ImGui::GetTextLineHeight(), right = at.x + wide;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(at, color(p.dim), what);
  const float text = ImGui::CalcTextSize(value.c_str()).x;
  list.AddText({right - text, at.y}, color(p.text), value.c_str());
  const float middle = at.y + 0.5f * high;
  ImGui::Dummy({wide, high});
  ImGui::PopFont();
  return {{at.x + px(label_wide), middle - 0.5f * px(kTrack)},
          {std::max(right - px(kValue), at.x + px(label_wide) + px(8)), middle + 0.5f * px(kTrack)},
          middle};
}

void track(const Row& row) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(row.low, row.high, color(palette().text, 0.10f), px(3));
}

// A position between two ends, from the centre.
void axis(const char* what, double at, double most, const std::string& value, const ImVec4& of, bool known) {
  const Row r = row(what, value);
  track(r);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float middle = 0.5f * (r.low.x + r.high.x), half = 0.5f * (r.high.x - r.low.x);
  list.AddLine({middle, r.low.y - px(2)}, {middle, r.high.y + px(2)}, color(palette().faint), px(1));
  if (!known) return;
  const float share = static_cast<float>(std::clamp(at / most, -1.0, 1.0)), x = middle + share * half;
  list.AddRectFilled({std::min(middle, x), r.low.y}, {std::max(middle, x), r.high.y}, color(of), px(2));
  list.AddRectFilled({x - px(1.5f), r.low.y - px(2)}, {x + px(1.5f), r.high.y + px(2)}, color(palette().text), px(1));
}

// From zero to the maximum; beyond it, an arrow.
void level(const char* what, double value, double most, const std::string& text, const ImVec4& of, float wide = 0,
           float label_wide = kLabel) {
  const Row r = row(what, text, wide, label_wide);
  track(r);
  if (!(value > 0.0) || !(most > 0.0)) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float share = static_cast<float>(std::min(value / most, 1.0));
  list.AddRectFilled(r.low, {r.low.x + std::max(px(2), share * (r.high.x - r.low.x)), r.high.y}, color(of), px(2));
  if (value <= 1.001 * most) return;
  list.AddTriangleFilled({r.high.x - px(2), r.low.y - px(3)}, {r.high.x + px(5), r.middle},
                         {r.high.x - px(2), r.high.y + px(3)}, color(palette().warning));
}

// The force seen from the front: x to the right, y up; z, towards the eye or away, is the bar beside it.
void dial(dvec3 wanted, dvec3 sent, double most) {
  const Palette& p = palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float r = 0.5f * px(kDial) - px(1);
  const ImVec2 c(low.x + r + px(1), low.y + r + px(1));
  list.AddCircleFilled(c, r, color(p.text, 0.06f), 40);
  list.AddCircle(c, r, color(p.text, 0.18f), 40, px(1));
  list.AddLine({c.x - r, c.y}, {c.x + r, c.y}, color(p.text, 0.12f));
  list.AddLine({c.x, c.y - r}, {c.x, c.y + r}, color(p.text, 0.12f));
  const auto arrow = [&](dvec3 force, const ImVec4& of, float thick, bool filled) {
    const double long_ = std::hypot(force.x, force.y);
    if (!(long_ > 0.005 * most)) return;
    const float share = static_cast<float>(std::min(long_ / most, 1.0)) * r;
    const ImVec2 way(static_cast<float>(force.x / long_), -static_cast<float>(force.y / long_));
    const ImVec2 tip(c.x + share * way.x, c.y + share * way.y);
    list.AddLine(c, tip, color(of), thick);
    if (!filled) {
      list.AddCircle(tip, px(3), color(of), 12, px(1.25f));
      return;
    }
    const float h = px(6);
    list.AddTriangleFilled(tip, {tip.x - h * way.x - 0.6f * h * way.y, tip.y - h * way.y + 0.6f * h * way.x},
                           {tip.x - h * way.x + 0.6f * h * way.y, tip.y - h * way.y - 0.6f * h * way.x}, color(of));
  };
  arrow(wanted, p.dim, px(1), false);
  arrow(sent, p.force, px(2), true);
  const float left = c.x + r + px(6);
  list.AddRectFilled({left, c.y - r}, {left + px(kTrack), c.y + r}, color(p.text, 0.10f), px(3));
  const float z = -static_cast<float>(std::clamp(sent.z / most, -1.0, 1.0)) * r;
  list.AddRectFilled({left, c.y + std::min(0.0f, -z)}, {left + px(kTrack), c.y + std::max(0.0f, -z)}, color(p.force),
                     px(2));
  list.AddLine({left - px(2), c.y}, {left + px(kTrack) + px(2), c.y}, color(p.faint), px(1));
  ImGui::Dummy({px(kDial) + px(6 + kTrack + 2), px(kDial)});
  hint(
      "The force on the hand, seen from the front: x to the right, y up. The bar beside it is z, down towards you. "
      "The thin line with a ring is what is wanted, the arrow what is sent; the circle is the limit.");
}

void draw_axes(const DeviceView& d) {
  const Palette& p = palette();
  const DeviceSample& s = d.report.sample;
  const bool known = fresh(d.report);
  if (d.can.senses_position) {
    constexpr const char* kNames[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
      const double most = d.can.workspace[i] > 0.0 ? d.can.workspace[i] : kUsualReach;
      axis(kNames[i], s.position[i], most, known ? fmt::format("{:.1f} mm", 1e3 * s.position[i]) : "-", p.axis[i],
           known);
    }
  }
  if (d.can.senses_rotation) {
    constexpr const char* kTurns[] = {"turn x", "turn y", "turn z"};
    const dvec3 turned = glm::degrees(glm::eulerAngles(s.rotation));
    for (int i = 0; i < 3; ++i)
      axis(kTurns[i], turned[i], 180.0, known ? fmt::format("{:.0f}\u00b0", turned[i] + 0.0) : "-", p.axis[i], known);
  }
  if (d.can.senses_grip)
    level("grip", known ? s.grip : 0.0, 1.0, known ? fmt::format("{:.0f} %", 100 * s.grip) : "-", p.depth);
  std::string down;
  for (std::uint32_t i = 0; i < 32; ++i)
    if (known && (s.buttons >> i & 1u)) down += (down.empty() ? "" : ", ") + std::to_string(i);
  const Row r = row("buttons", down.empty() ? "none" : down);
  const float cell = (r.high.x - r.low.x) / static_cast<float>(kButtonsShown), side = std::min(cell - px(2), px(8));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::uint32_t i = 0; i < kButtonsShown; ++i) {
    const ImVec2 low(r.low.x + static_cast<float>(i) * cell, r.middle - 0.5f * side);
    const bool on = known && (s.buttons >> i & 1u);
    if (on)
      list.AddRectFilled(low, {low.x + side, low.y + side}, color(p.accent), px(2));
    else
      list.AddRect(low, {low.x + side, low.y + side}, color(p.text, 0.25f), px(2));
  }
}

void draw_force(const DeviceView& d) {
  const Palette& p = palette();
  const DeviceReport& r = d.report;
  const double wanted = length(r.wanted.force), sent = length(r.sent.force);
  const double most = r.max_force > 0.0 ? r.max_force : d.can.max_force > 0.0 ? d.can.max_force : 10.0;
  gap(2);
  dial(r.wanted.force, r.sent.force, most);
  ImGui::SameLine(0, px(kPad));
  ImGui::BeginGroup();
  const float wide = ImGui::GetContentRegionAvail().x;
  constexpr float kShort = 46;
  level("wanted", wanted, most, fmt::format("{:.2f} N", wanted), p.dim, wide, kShort);
  level("sent", sent, most, fmt::format("{:.2f} N", sent), p.force, wide, kShort);
  ImGui::PushFont(font(Type::kSmall));
  std::string limit = r.max_force > 0.0 ? fmt::format("limit {:.2f} N", r.max_force) : std::string("no limit is said");
  if (r.heat > 0.02) limit += fmt::format("   heat {:.0f} %", 100 * r.heat);
  dim(limit.c_str());
  if (d.can.resists_only) dim("It brakes or shakes, and cannot push.");
  ImGui::PopFont();
  ImGui::EndGroup();
}

void draw_rates(const DeviceView& d, std::uint64_t late_ticks) {
  const ServoFigures& f = d.report.figures;
  ImGui::PushFont(font(Type::kSmall));
  std::string line;
  if (d.can.rate > 0.0 && renders(d.can)) {
    line = fmt::format("{:.0f} of {:.0f} Hz", f.rate, d.can.rate);
    if (f.read_p50 > 0.0) line += fmt::format(", read after {:.2f} ms", 1e-3 * f.read_p50);
    if (f.round_trip_p50 > 0.0) line += fmt::format(", round trip {:.2f} ms", 1e-3 * f.round_trip_p50);
    line += fmt::format("; jitter {:.2f} ms; missed deadlines {}, late models {}", 1e-3 * f.jitter, f.missed,
                        f.late_models);
    if (!f.has_priority) line += "; without SCHED_FIFO";
  } else {
    line = fmt::format("{:.0f} samples a second, read by the touch clock", f.rate);
  }
  line += fmt::format(", late ticks {}", late_ticks);
  dim(line.c_str());
  hint(
      "How often the device is served; how long its sample took to be read; deadlines that its own loop missed; force "
      "models that came later than two ticks; ticks of the touch clock that could not begin in time.");
  ImGui::PopFont();
}

void draw_warnings(const DeviceView& d) {
  const Palette& p = palette();
  const DeviceSample& s = d.report.sample;
  const auto warn = [&](const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, p.warning);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
  };
  if (d.report.sample_age < 0.0)
    warn("No sample has come yet. Is it switched on?");
  else if (!fresh(d.report))
    warn(fmt::format("No sample for {:.1f} s. It is looked for: plug it in, or switch it on.", d.report.sample_age));
  else if (!s.ready)
    warn("The device says that its state is not known: check its calibration.");
  if (s.warnings & kDeviceWarm) warn("It is warm: its force is lowered.");
  if (s.warnings & kDeviceBatteryLow) warn("Its battery is low: its force is taken away.");
  if (s.battery >= 0.0)
    level("battery", s.battery, 1.0, fmt::format("{:.0f} %{}", 100 * s.battery, s.charging ? ", charging" : ""),
          s.battery < 0.2 && !s.charging ? p.bad : p.good);
}

void draw_device(const DeviceView& d, std::uint64_t late_ticks, DeviceOrders& orders) {
  if (!section(printable(d.effector).c_str())) return;
  const Scope scope(d.effector);
  ImGui::PushID(d.effector.c_str());
  ImGui::TextUnformatted(printable(d.name).c_str());
  if (d.id != d.name) {
    ImGui::PushFont(font(Type::kSmall));
    dim(printable(d.id).c_str());
    ImGui::PopFont();
  }
  gap(2);
  const DeviceState state = d.report.state;
  const float start = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
  const float below = 0.5f * (ImGui::GetFrameHeight() - ImGui::GetTextLineHeight());
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + below);
  state_sign(state);
  ImGui::SameLine(0, px(6));
  ImGui::PushFont(font(Type::kStrong));
  ImGui::TextColored(color_of(state), "%s", state_word(d));
  known_as(state_word(d));
  ImGui::PopFont();
  if (renders(d.can)) {
    const bool runs = state == DeviceState::kArmed || state == DeviceState::kActive, there = fresh(d.report);
    ImGui::SameLine(start + wide - px(144));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - below);
    if (runs) {
      if (button("Disarm", "No force until it is armed", true, 76)) orders.disarm.push_back(d.effector);
    } else if (strong_button("Arm",
                             there ? "Force comes in once the wanted force is small, over 0.2 s"
                                   : "It says nothing, and cannot be armed",
                             there, 76)) {
      orders.arm.push_back(d.effector);
    }
    ImGui::SameLine(0, px(4));
    if (button("Stop", "This device's force is zero at once, and stays so until it is armed", true, 64))
      orders.stop.push_back(d.effector);
  }
  if (d.report.cause != DeviceCause::kNone) {
    ImGui::PushFont(font(Type::kSmall));
    std::string why = describe(d.report.cause);
    if (!why.empty()) why[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(why[0])));
    ImGui::PushStyleColor(ImGuiCol_Text, state == DeviceState::kTripped ? palette().bad : palette().dim);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted((why + ".").c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopFont();
  }
  draw_warnings(d);
  gap(2);
  draw_axes(d);
  if (renders(d.can)) draw_force(d);
  draw_rates(d, late_ticks);
  gap(kGap);
  ImGui::PopID();
}

}  // namespace

const char* state_word(const DeviceView& device) {
  switch (device.report.state) {
    case DeviceState::kDisconnected:
      return "Disconnected";
    case DeviceState::kIdle:
      return "Idle";
    case DeviceState::kArmed:
      return "Armed";
    case DeviceState::kActive:
      return renders(device.can) ? "Active" : "Connected";
    case DeviceState::kTripped:
      return device.report.cause == DeviceCause::kEmergencyStop ? "Stopped" : "Tripped";
  }
  return "";
}

std::string devices_badge(const DevicesView& view) {
  std::size_t tripped = 0;
  for (const DeviceView& each : view.devices) tripped += each.report.state == DeviceState::kTripped;
  if (tripped > 0) return fmt::format("{} stopped", tripped);
  return view.devices.empty() ? std::string() : std::to_string(view.devices.size());
}

void device_list(const DevicesView& view, const std::string& stop_keys, DeviceOrders& orders) {
  const Palette& p = palette();
  bool any_force = false;
  for (const DeviceView& each : view.devices) any_force |= renders(each.can);
  if (any_force) {
    ImGui::PushStyleColor(ImGuiCol_Button, p.bad);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, p.bad);
    ImGui::PushStyleColor(ImGuiCol_Text, p.panel);
    ImGui::PushFont(font(Type::kStrong));
    const std::string label = fmt::format("Emergency stop{}###Stop all", stop_keys.empty() ? "" : "   " + stop_keys);
    const bool pressed = ImGui::Button(label.c_str(), {-1, px(30)});
    known_as("Stop all");
    ImGui::PopFont();
    ImGui::PopStyleColor(3);
    hint("Every device's force is zero at once, and stays so until each is armed");
    orders.stop_all |= pressed;
    gap(2);
  }
  for (const DeviceView& each : view.devices) draw_device(each, view.late_ticks, orders);
  if (!view.others.empty() && section("Without a device", view.devices.empty())) {
    ImGui::PushFont(font(Type::kSmall));
    for (const DevicesView::Other& other : view.others)
      dim(fmt::format("{}: {}", printable(other.effector), printable(other.source)).c_str());
    ImGui::PopFont();
  }
  if (view.devices.empty() && view.others.empty()) dim("Nothing here is moved by a device.");
  if (view.unusable.empty()) return;
  gap(kGap);
  if (!section("Not usable yet", view.devices.empty())) return;
  for (const DeviceInfo& device : view.unusable) {
    ImGui::TextUnformatted(printable(device.name).c_str());
    dim(printable(device.missing).c_str());
    gap(2);
  }
}

}  // namespace pliant::ui
