// Input for tests, from a file. Widgets are addressed by name, so that a script survives a change of the layout. Each
// step begins when the editor is idle after the previous one: presses are processed, and pictures show the current
// document. Invisible widgets cannot be pressed. A step fails if its place is covered by another window, scrolled out,
// disabled, of zero size, or behind an open menu or question; the error gives the reason.
//
// One step per line; # begins a comment. PLACE is a widget's address (ui/widgets.h), with @X,Y a share of its width and
// height (Viewport@0.5,0.5), or two numbers of pixels.
//   click PLACE [right] [double] [shift] [control] [alt]     press and release; a PLACE in pixels is not checked
//   drag PLACE to PLACE [MODIFIER...] [in SECONDS]           with the left button; `right`, `middle`
//   press PLACE / move PLACE / release                       the same in parts
//   wheel PLACE CLICKS
//   key Ctrl+Shift+S                                         press and release
//   type TEXT                                                the rest of the line
//   at-once                                                  the events of the steps up to `now` arrive in one frame,
//   now                                                      like input during a slow frame
//   slow SECONDS                                             minimal duration of each frame
//   set PLACE VALUE                                          types VALUE into a number or text field
//   wait SECONDS
//   await PLACE [SECONDS]                                    until a widget at that address exists, enabled, uncovered
//   expect PLACE / expect-no PLACE                           an error unless it exists (or not); covered counts as
//                                                            missing, scrolled out as existing
//   apart                                                    an error if a widget overlaps another, is covered, or is
//                                                            cut off without scrolling
//   hear TEXT                                                until the console's text contains it
//   say TEXT                                                 an error unless the console's text contains it
//   screenshot FILE.png                                      into the folder of --out
//   felt FILE.csv                                            tick, time, force, depth of each probe and tool, likewise
//   figures NAME                                             prints frame times since the last `figures`
//   drop FILE [| FILE...]
//   close
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/result.h"
#include "viewer/window/window_input.h"

namespace pliant::ui {

struct Manner;
using Spot = std::pair<double, double>;  // [px]

class Script {
 public:
  static Result<Script> load(const std::filesystem::path& file);

  struct Surroundings {
    std::string under_way;                               // "": the editor is idle
    double now = 0.0;                                    // [s]
    std::function<void(const std::string&)> screenshot;  // of the next frame
    std::function<bool(const std::string&)> has_said;
    std::function<void(const std::string&)> figures;
    std::function<Status(const std::string&)> felt;
    std::function<void(double)> slow;  // [s] each frame from now on takes at least
  };
  // Appends the events of the next frame. The error names the line.
  Status next(const Surroundings& at, std::vector<InputEvent>& events);
  bool done() const;                                     // and what it did last has been answered
  Error ended(std::string why, std::string cure) const;  // at its last line

 private:
  struct Step {
    std::size_t line = 0;
    std::string verb;
    std::vector<std::string> words;
    std::string rest;
  };
  enum class Need : std::uint8_t { kThere, kUncovered, kPress };
  Result<Spot> place(const std::string& text, bool& there, Need need) const;
  Error wrong(const Step& step, std::string what, std::string cure = {}) const;
  Error wrong(const Step& step, const Error& why) const { return wrong(step, why.what, why.cure); }
  // Each appends the step's frames of events. `waits`: the step cannot begin yet.
  Status begin(const Step& step, const Surroundings& at, bool& waits);
  Status begin_press(const Step& step, bool& waits);  // click, press, move, drag
  Status begin_wheel(const Step& step);
  Status begin_set(const Step& step, bool& waits);
  Status begin_await(const Step& step, const Surroundings& at, bool& waits);
  Status begin_expect(const Step& step, bool& waits);
  void begin_drop(const Step& step);  // drop, close
  void pointer_events(const Step& step, const Manner& manner, Spot from, Spot to);
  void key_events(const std::string& keys);
  void text_events(const std::string& text);

  std::string file_;
  std::deque<Step> steps_;
  std::deque<std::vector<InputEvent>> frames_;  // of the step under way
  double until_ = 0.0, began_ = -1.0;           // [s]
  int rest_ = 0;                                // frames since the last event
  std::size_t line_ = 0;                        // of the last step that was begun
  bool at_once_ = false;                        // steps gather in one frame
  std::string awaited_;                         // by the step before; "": it was no `await`
};

}  // namespace pliant::ui
