// The loop of a window: what it holds, what a hand does to it (window_loop_input.cpp), and a turn of it
// (window_loop.cpp). It hears the hand some 250 times a second; pictures are made meanwhile (window_picture.h).
#pragma once

#include <future>
#include <optional>

#include "player/window/overlay.h"
#include "player/window/window_picture.h"
#include "player/window/window_session.h"
#include "window/camera_control.h"
#include "window/carrier.h"
#include "window/pointer.h"

namespace pliant {

// What a held button does. kAsked: that hangs on what a picture shows under it, which is not known yet.
enum class Drag : std::uint8_t { kNone, kAsked, kPress, kPull, kCarry, kOrbit, kPan };

// The probe that the mouse moves.
struct MouseProbe {
  double radius = 0.0;  // [m]
  ProbeMeets meets = ProbeMeets::kAll;
};

// What one session holds while it runs. The touch clock owns the world meanwhile: this side reads only what never
// changes (remembered before it started) and what comes by exchanges.
class WindowLoop {
 public:
  WindowLoop(WindowSession& session, Renderer& renderer);

  // Until the window closes, the ticks are over or another level is ready.
  WindowFigures run();

 private:
  Status warm_up();
  Status turn_until_the_end();
  void handle(const InputEvent& event);
  void key(int key);
  void emergency_stop();
  void press_widgets();
  void press(const InputEvent& event);
  void decide(const std::optional<Picked>& seen);
  void release();
  void move(const InputEvent& event);
  void wheel(const InputEvent& event);
  void answer_question(bool allowed);
  void open(const std::string& file);  // on a thread of its own
  void look_for_opened();
  void say(const std::string& sentence, bool error);
  void point(double dt);
  void keep();  // rows of the journal
  PictureOrder order(bool shown);
  Status learn(const PictureDone& done);
  std::filesystem::path next_frame();
  std::filesystem::path next_screenshot() const;
  ViewRay ray() const;
  bool looks_around() const { return drag_ == Drag::kOrbit || drag_ == Drag::kPan; }

  WindowSession& s_;
  CameraControl camera_;
  std::optional<MouseProbe> of_mouse_;  // the probe at the mouse
  Pointer pointer_;
  std::optional<Carrier> carrier_;
  HeavyCursor cursor_;
  RenderOptions options_, ordered_options_;  // as wanted now, and for the picture under way
  OverlayState state_;
  OverlayMouse mouse_;
  std::array<bool, 3> down_{};                        // buttons now; a click between two pictures is in mouse_ alone
  float tint_;                                        // [m] height that is coloured fully, where heights are
  dvec3 probe_at_{0};                                 // [m] where the mouse has its probe or its tool
  dvec3 tool_at_{0};                                  // [m] world, where the device of the carried tool was last
  std::optional<std::size_t> mouse_probe_, carried_;  // numbers in the journal
  TouchClock* touch_ = nullptr;                       // null: before it starts
  std::vector<ui::Place> widgets_;                    // of the last picture
  std::string wanted_widget_;                         // that a script presses once it is there
  double wanted_since_ = 0.0;                         // [s]
  Drag drag_ = Drag::kNone;
  MouseButton dragging_ = MouseButton::kLeft;
  bool wants_pull_ = false;                    // the press under way was made with Ctrl
  double pressed_x_ = 0.0, pressed_y_ = 0.0;   // [pixel] where it is asked what was pressed
  std::optional<PickAnswer> answer_;           // the newest
  ViewRay asked_ray_;                          // of the question under way
  std::uint64_t questions_ = 0, decides_ = 0;  // asked so far; the one whose answer decides a press
  bool pointed_ = false, close_ = false, wants_mouse_ = false;
  bool begun_ = false;                    // a picture that is shown has been ordered
  int screenshots_ = 0;                   // asked for, not yet taken
  std::filesystem::path shooting_;        // of the picture under way
  double frame_time_ = 0.0;               // [s] smoothed
  double seconds_ = 0.0, said_at_ = 0.0;  // [s] since the first picture
  double ordered_at_ = 0.0;               // [s] when the picture under way was
  std::size_t next_frame_ = 0;
  std::future<std::optional<Error>> opening_;
  WindowFigures figures_;
  WindowPictures pictures_;  // last: it has the context from its beginning to its end
};

}  // namespace pliant
