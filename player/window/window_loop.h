// The loop of a window: its state, its reaction to input (window_loop_input.cpp), and an iteration (window_loop.cpp).
// It polls input some 250 times a second while pictures are drawn on another thread (window_picture.h).
#pragma once

#include <future>
#include <optional>

#include "player/window/overlay.h"
#include "player/window/path_record.h"
#include "player/window/window_picture.h"
#include "player/window/window_session.h"
#include "viewer/hand/mouse_hand.h"

namespace pliant {

// Action of a held mouse button. kAsked: depends on the object under the cursor, which is not known yet. kHand: its
// grip.
enum class Drag : std::uint8_t { kNone, kAsked, kHand, kOrbit, kPan };

// State of one session while it runs. The touch clock owns the world meanwhile: this side reads only constant data
// (copied before the start) and data from exchanges.
class WindowLoop {
 public:
  WindowLoop(WindowSession& session, Renderer& renderer);

  // Runs until the window closes, the ticks are over, or another level is ready.
  WindowFigures run();

 private:
  Status warm_up();
  Status turn_until_the_end();
  void handle(const InputEvent& event);
  void key(int key);
  void emergency_stop();
  void press_widgets();
  void press(const InputEvent& event);
  void decide();
  void release();
  void move(const InputEvent& event);
  void wheel(const InputEvent& event);
  void answer_question(bool allowed);
  void open(const std::string& file);  // on a separate thread
  void look_for_opened();
  void say(const std::string& sentence, bool error);
  void list_hands();
  void list_sliders();
  void hold(std::size_t which);  // into holdable_
  void record();                 // starts, or ends and saves
  void set_slider(std::size_t which, double value);
  void undo_slider();
  void take(const PanelOrders& orders);
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
  MouseHand hand_;
  HeavyCursor cursor_;
  RenderOptions options_, ordered_options_;  // as wanted now, and of the current picture
  OverlayState state_;
  OverlayMouse mouse_;
  std::array<bool, 3> down_{};                        // now; a click between two pictures is in mouse_ alone
  float tint_;                                        // [m] height at full colour
  dvec3 probe_at_{0};                                 // [m] target of the probe or tool under the mouse
  dvec3 tool_at_{0};                                  // [m] world, last position of the carried tool's device
  std::optional<std::size_t> mouse_probe_, carried_;  // indices in the journal
  struct Holdable {
    std::size_t journal;  // its index there
    Entity device;
    MouseHand hand;  // as prepared before the start
    dvec3 at{0};     // [m] world, last position of its device
  };
  std::vector<Holdable> holdable_;  // probes and tools that the mouse can move
  Entity taken_ = kNoEntity;        // the device of a probe that was chosen
  PathRecord record_;
  std::vector<std::vector<double>> undo_;  // values of all sliders
  TouchClock* touch_ = nullptr;            // null before the start
  std::vector<ui::Place> widgets_;         // of the last picture
  std::string wanted_widget_;              // to be pressed by a script once it is visible
  double wanted_since_ = 0.0;              // [s]
  Drag drag_ = Drag::kNone;
  MouseButton dragging_ = MouseButton::kLeft;
  bool wants_pull_ = false;                    // the current press was made with Ctrl
  double pressed_x_ = 0.0, pressed_y_ = 0.0;   // [pixel] place of the current press
  std::optional<PickAnswer> answer_;           // the newest
  ViewRay asked_ray_;                          // of the pending question
  std::uint64_t questions_ = 0, decides_ = 0;  // number of questions so far; the one whose answer decides a press
  bool pointed_ = false, close_ = false, wants_mouse_ = false;
  bool begun_ = false;                    // a visible picture has been ordered
  int screenshots_ = 0;                   // requested, not yet taken
  std::filesystem::path shooting_;        // of the current picture
  double frame_time_ = 0.0;               // [s] smoothed
  double seconds_ = 0.0, said_at_ = 0.0;  // [s] since the first picture
  double ordered_at_ = 0.0;               // [s] time of the current picture's order
  std::size_t next_frame_ = 0;
  std::future<std::optional<Error>> opening_;
  WindowFigures figures_;
  WindowPictures pictures_;  // last member: it owns the context from construction to destruction
};

}  // namespace pliant
