// The overlay on the picture: figures, a live plot for every probe, switches, keys. Dear ImGui, drawn last.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/math.h"
#include "engine/run/device_view.h"
#include "engine/run/journal.h"
#include "engine/run/soft_clock.h"
#include "engine/run/touch_clock.h"
#include "player/window/side_panel.h"
#include "systems/visual/renderer.h"
#include "viewer/ui/widgets.h"

namespace pliant {

// The last seconds of one probe in bins of equal time, each with its largest force and depth.
class ProbeHistory {
 public:
  static constexpr double kSeconds = 5.0;  // [s]
  static constexpr std::size_t kBins = 500;
  static constexpr double kLimitSeconds = 0.5;  // [s] long enough to be read

  void add(const TickRow& row);
  struct Bin {
    std::int64_t number = -1;              // index of the bin since the start; another index here means an empty bin
    float force = 0;                       // [N]
    float depth = 0;                       // [m] in contact, else 0
    float pair_force = 0, pair_depth = 0;  // [N] along the normal, [m]: both of the bin's last tick
    std::uint8_t limited = 0;              // 1 << SafetyLimit: limits that acted
  };
  // `age` 0 is the newest bin, kBins - 1 the oldest; null for an empty bin.
  const Bin* bin(std::size_t age) const;
  std::uint8_t limited() const;  // limits that acted in the last kLimitSeconds, as bits
  const Bin& newest() const { return bins_[static_cast<std::size_t>(newest_) % kBins]; }

 private:
  std::array<Bin, kBins> bins_;
  std::int64_t newest_ = 0;
};

struct ProbeLine {
  std::string name, source;
  vec3 color{0};  // linear
  ProbeHistory history;
};

// The panel's switches, in order, and the keys of some (viewer/window/keys.h).
struct Switch {
  const char* name;
  bool RenderOptions::*of;  // null: tint_height
  const char* id;
};
std::span<const Switch> switches();

// Everything that the overlay shows; the drawing code keeps it current.
struct OverlayState {
  bool figures = true, help = false;  // visible parts
  std::string title;
  TouchFigures touch;
  double rate_wanted = 1000.0;      // [Hz]
  std::optional<SoftFigures> soft;  // empty: the level has no soft parts
  double frames_per_second = 0.0;   // [Hz]
  double draw_ms = 0.0;             // [ms]
  double resolution = 1.0;          // [1] of the window's, per axis
  std::uint64_t upload_bytes = 0;   // of the last frame
  std::uint64_t awake_vertices = 0;
  bool paused = false;
  std::string message;  // a temporary message; empty: none
  bool message_is_error = false;
  std::vector<ProbeLine> probes;
  SidePanel panel;
  bool show_devices = false;
  DevicesView devices;
  std::string stop_keys;              // of the emergency stop
  std::vector<std::string> question;  // question about the level's device requests, line by line; empty: none
  // The cursor of a probe driven by the mouse. [pixel]
  bool cursor = false, pressing = false;
  double cursor_x = 0, cursor_y = 0;
  double cursor_force = 0;  // [N]
};

// Mouse input for ImGui.
struct OverlayMouse {
  double x = -1, y = -1;  // [pixel]
  std::array<bool, 3> down{};
  double wheel = 0;
};

class Overlay {
 public:
  explicit Overlay(float scale);  // needs the window's context, as does every call
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // True while the mouse is over a panel: the scene ignores it.
  bool wants_mouse() const;
  // Draws over framebuffer 0. Switches change `options`; `tint` [m]: height at full colour.
  void draw(const OverlayState& state, RenderOptions& options, float tint, const OverlayMouse& mouse, int width,
            int height, double dt);
  // Commands from the device panel since the last call.
  DeviceOrders take_orders() { return std::exchange(orders_, {}); }
  // The same from the side panel.
  PanelOrders take_panel_orders() { return std::exchange(panel_orders_, {}); }

 private:
  void draw_panel(const OverlayState& state, RenderOptions& options, float tint);
  void draw_devices(const OverlayState& state);
  void draw_side_panel(const OverlayState& state);
  void draw_question(const OverlayState& state);
  float scale_;
  bool large_ = false;
  DeviceOrders orders_;
  PanelOrders panel_orders_;
};

}  // namespace pliant
