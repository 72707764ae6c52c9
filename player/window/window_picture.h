// Draws the pictures of a window on a separate thread with the window's context, so that a slow picture does not block
// input.
#pragma once

#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "components/world.h"
#include "player/window/overlay.h"
#include "systems/visual/gpu/framebuffer.h"
#include "viewer/picture/picture_budget.h"
#include "viewer/window/window.h"

namespace pliant {

// Order for the next picture.
struct PictureOrder {
  Viewpoint view;
  int width = 1, height = 1;  // [pixel] of the window
  double dt = 0.0;            // [s] since the previous order
  RenderOptions options;
  OverlayState overlay;
  OverlayMouse mouse;
  float tint = 0.0f;  // [m] height at full colour
  PickQuestion question;
  std::filesystem::path screenshot;       // file for the window with all overlays; empty: none
  std::filesystem::path frame;            // file for the scene alone; empty: none
  int frame_width = 1, frame_height = 1;  // [pixel] of that
  bool shown = true;                      // false: warm-up of the driver, not shown
};

// Result of a picture.
struct PictureDone {
  FrameStats stats;
  RenderOptions options;     // as changed by the overlay's switches
  bool wants_mouse = false;  // the mouse is over a panel: the scene ignores it
  DeviceOrders orders;       // commands from the device panel
  PanelOrders panel_orders;
  std::vector<ui::Place> widgets;
  std::optional<PickAnswer> answer;
  std::uint64_t awake_vertices = 0;
  double resolution = 1.0;  // [1] of the window's, per axis
  Status screenshot = Done{}, frame = Done{};
  bool framed = false;     // the file of the scene alone is written
  Status failed = Done{};  // error of the renderer; then only `framed` is valid
};

class WindowPictures {
 public:
  // Takes the context from the calling thread. Only this thread reads the world's snapshots.
  WindowPictures(Window& window, World& world, Renderer& renderer);
  ~WindowPictures();  // returns the context
  WindowPictures(const WindowPictures&) = delete;
  WindowPictures& operator=(const WindowPictures&) = delete;

  // Starts a picture; none may be in progress.
  void begin(PictureOrder order);
  bool busy() const;
  double seconds() const;  // [s] time taken so far by the current picture, else 0
  // Waits for the previous picture and returns its result.
  const PictureDone& done();
  // Returns false if a picture is still in progress after this time [s].
  bool wait(double seconds);

 private:
  void run();
  void draw_when_ordered();
  void take_snapshots();
  FrameStats draw_scene(double share);
  void draw();

  Window& window_;
  World& world_;
  Renderer& renderer_;
  float scale_;
  std::optional<Overlay> overlay_;
  gpu::Framebuffer coarse_;  // the picture at less than full resolution
  PictureBudget budget_;
  PictureOrder order_;  // owned by this thread during a picture, else by the other; likewise done_
  PictureDone done_;
  std::exception_ptr failure_;  // of the thread, before its first picture
  mutable std::mutex mutex_;    // guards the four members below
  std::condition_variable changed_;
  bool busy_ = false, stop_ = false;
  std::uint64_t began_ns_ = 0;
  std::thread thread_;  // last member: everything else exists when it starts
};

}  // namespace pliant
