// What stands over the picture: figures, a live plot for every probe, switches, keys. Dear ImGui, drawn last.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/math.h"
#include "editor/ui/widgets.h"
#include "engine/run/device_view.h"
#include "engine/run/journal.h"
#include "engine/run/soft_clock.h"
#include "engine/run/touch_clock.h"
#include "systems/visual/renderer.h"

namespace pliant {

// The last seconds of one probe, in bins of equal time, each with its largest force and depth.
class ProbeHistory {
 public:
  static constexpr double kSeconds = 5.0;  // [s]
  static constexpr std::size_t kBins = 500;
  static constexpr double kLimitSeconds = 0.5;  // [s] long enough to be read

  void add(const TickRow& row);
  struct Bin {
    std::int64_t number = -1;  // which bin since the start; another number in its place: nothing happened here
    float force = 0;           // [N]
    float depth = 0;           // [m] of a contact, else 0
    std::uint8_t limited = 0;  // 1 << SafetyLimit: what acted
  };
  // `age` 0 is the newest bin, kBins - 1 the oldest; null where nothing was noted.
  const Bin* bin(std::size_t age) const;
  std::uint8_t limited() const;  // what acted in the last kLimitSeconds, as bits
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

// Everything that is shown; whoever draws keeps it up to date.
struct OverlayState {
  bool figures = true, help = false;  // what is shown
  std::string title;
  TouchFigures touch;
  double rate_wanted = 1000.0;      // [Hz]
  std::optional<SoftFigures> soft;  // none: the level has nothing soft
  double frames_per_second = 0.0;   // [Hz]
  double draw_ms = 0.0;             // [ms]
  double resolution = 1.0;          // [1] of the window's, each way
  std::uint64_t upload_bytes = 0;   // of the last frame
  std::uint64_t awake_vertices = 0;
  bool paused = false;
  std::string message;  // a sentence for a while; empty: none
  bool message_is_error = false;
  std::vector<ProbeLine> probes;
  bool show_devices = false;
  DevicesView devices;
  std::string stop_keys;              // of the emergency stop
  std::vector<std::string> question;  // whether the level may have what it asks for, line by line; empty: none
  // The cursor, where a probe is driven by the mouse. [pixel]
  bool cursor = false, pressing = false;
  double cursor_x = 0, cursor_y = 0;
  double cursor_force = 0;  // [N]
};

// The mouse as ImGui sees it.
struct OverlayMouse {
  double x = -1, y = -1;  // [pixel]
  std::array<bool, 3> down{};
  double wheel = 0;
};

class Overlay {
 public:
  explicit Overlay(float scale);  // needs the window's context, as every call
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // The mouse is over a panel: it is not for the scene.
  bool wants_mouse() const;
  // Draws over framebuffer 0. Switches change `options`; `tint` [m] is what the heights' colours then mean.
  void draw(const OverlayState& state, RenderOptions& options, float tint, const OverlayMouse& mouse, int width,
            int height, double dt);
  // What was pressed in the panel of devices since the last call.
  DeviceOrders take_orders() { return std::exchange(orders_, {}); }

 private:
  void draw_panel(const OverlayState& state, RenderOptions& options, float tint);
  void draw_devices(const OverlayState& state);
  void draw_question(const OverlayState& state);
  float scale_;
  bool large_ = false;
  DeviceOrders orders_;
};

}  // namespace pliant
