// The pictures of a window, on a thread of their own with the window's context: however long one takes, the thread that
// hears the hand goes on hearing it.
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
#include "window/window.h"

namespace pliant {

// What the next picture is to be.
struct PictureOrder {
  Viewpoint view;
  int width = 1, height = 1;  // [pixel] of the window
  double dt = 0.0;            // [s] since the order before
  RenderOptions options;
  OverlayState overlay;
  OverlayMouse mouse;
  float tint = 0.0f;  // [m] height that is coloured fully, where heights are
  PickQuestion question;
  std::filesystem::path screenshot;       // a file of the window, with everything over it; empty: none
  std::filesystem::path frame;            // a file of the scene alone; empty: none
  int frame_width = 1, frame_height = 1;  // [pixel] of that
  bool shown = true;                      // false: drawn for the driver's sake, before anybody looks
};

// What came of it.
struct PictureDone {
  FrameStats stats;
  RenderOptions options;     // as the overlay's switches left them
  bool wants_mouse = false;  // the mouse is over a panel: it is not for the scene
  DeviceOrders orders;       // what was pressed in the panel of devices
  std::vector<ui::Place> widgets;
  std::optional<PickAnswer> answer;
  std::uint64_t awake_vertices = 0;
  double resolution = 1.0;  // [1] of the window's, each way
  Status screenshot = Done{}, frame = Done{};
  bool framed = false;     // the file of the scene alone is written
  Status failed = Done{};  // the renderer; nothing above holds but `framed`
};

class WindowPictures {
 public:
  // Takes the context from the calling thread. The world's snapshots are read here and nowhere else.
  WindowPictures(Window& window, World& world, Renderer& renderer);
  ~WindowPictures();  // and gives it back
  WindowPictures(const WindowPictures&) = delete;
  WindowPictures& operator=(const WindowPictures&) = delete;

  // Starts a picture; none may be under way.
  void begin(PictureOrder order);
  bool busy() const;
  double seconds() const;  // [s] that the picture under way has taken so far, else 0
  // What came of the picture before, waiting for it.
  const PictureDone& done();
  // False: after so long [s] a picture is still under way.
  bool wait(double seconds);

 private:
  void run();
  void draw_when_ordered();
  void take_snapshots();
  FrameStats draw_scene(double share);
  void choose_share(double draw_ms);
  void draw();

  Window& window_;
  World& world_;
  Renderer& renderer_;
  float scale_;
  std::optional<Overlay> overlay_;
  gpu::Framebuffer coarse_;  // the picture at less than full resolution
  double share_ = 1.0;       // [1] of the window's resolution, each way
  double draw_ms_ = 0.0;     // [ms] of the picture before
  std::uint64_t awake_ = 0;
  PictureOrder order_;  // this thread's while a picture is under way, else the other's; so is done_
  PictureDone done_;
  std::exception_ptr failure_;  // of the thread, before its first picture
  mutable std::mutex mutex_;    // of the four below
  std::condition_variable changed_;
  bool busy_ = false, stop_ = false;
  std::uint64_t began_ns_ = 0;
  std::thread thread_;  // last: everything else is there when it starts
};

}  // namespace pliant
