// The loop of a window: what it holds, what a hand does to it (window_loop_input.cpp), and a turn of it
// (window_loop.cpp).
#pragma once

#include <future>
#include <optional>

#include "player/camera_control.h"
#include "player/overlay.h"
#include "player/window_pointer.h"
#include "player/window_session.h"
#include "systems/visual/gpu/framebuffer.h"

namespace pliant {

// What a held button does.
enum class Drag : std::uint8_t { kNone, kPress, kOrbit, kPan };

// What one session holds while it runs. The touch clock owns the world meanwhile: this side reads only what never
// changes (remembered before it started) and what comes by exchanges.
class WindowLoop {
 public:
  WindowLoop(WindowSession& session, Renderer& renderer);

  // Until the window closes, the ticks are over or another level is ready.
  Result<WindowFigures> run();

 private:
  void handle(const InputEvent& event);
  void key(int key);
  void press(const InputEvent& event);
  void move(const InputEvent& event);
  void wheel(const InputEvent& event);
  void open(const std::string& file);  // on a thread of its own
  void look_for_opened();
  void say(std::string sentence, bool error);
  void screenshot();
  void point(double dt);
  void keep();            // rows of the journal
  void take_snapshots();  // of the touch clock
  Status draw(double dt);
  FrameStats draw_scene(double share);
  void choose_share(double draw_ms);
  Status stage_frames();
  Ray ray() const;

  WindowSession& s_;
  Renderer& renderer_;
  CameraControl camera_;
  std::optional<double> radius_;  // [m] of the probe at the mouse
  Pointer pointer_;
  HeavyCursor cursor_;
  Overlay overlay_;
  OverlayState state_;
  OverlayMouse mouse_;
  gpu::Framebuffer coarse_;  // the picture at less than full resolution
  double share_ = 1.0;       // [1] of the window's resolution, each way
  float tint_;               // [m] height that is coloured fully, where heights are
  dvec3 probe_at_{0};        // [m] where the mouse has its probe
  std::optional<std::size_t> mouse_probe_;
  std::optional<TouchThread> touch_;
  Drag drag_ = Drag::kNone;
  MouseButton dragging_ = MouseButton::kLeft;
  bool pointed_ = false, close_ = false, wants_screenshot_ = false;
  double frame_time_ = 0.0;               // [s] smoothed
  double seconds_ = 0.0, said_at_ = 0.0;  // [s] since the first picture
  std::size_t next_frame_ = 0;
  std::future<std::optional<Error>> opening_;
  WindowFigures figures_;
};

}  // namespace pliant
