// Input events of a window, from GLFW or from a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

enum class InputKind : std::uint8_t {
  kMove,
  kPress,
  kRelease,
  kWheel,
  kKey,
  kKeyUp,
  kText,
  kDrop,
  kFocus,
  kClose,
  kWidget
};
enum class MouseButton : std::uint8_t { kLeft, kRight, kMiddle };  // in the order of GLFW and Dear ImGui
enum ModifierBit : std::uint8_t { kShift = 1, kControl = 2, kAlt = 4, kSuper = 8 };

struct InputEvent {
  InputKind kind = InputKind::kMove;
  double x = 0, y = 0;  // [pixel] from the upper left corner; for the wheel, y: clicks, > 0 away from the user
  MouseButton button = MouseButton::kLeft;
  int key = 0;                          // GLFW's number; for kText: the code point
  bool repeated = false;                // for kKey: auto-repeat
  std::uint8_t modifiers = 0;           // ModifierBit
  std::string file;                     // the first dropped file; for kWidget (only in scripts): its address
  std::vector<std::string> files = {};  // all that were dropped
};

// Events from a file, for automated tests of the window. Columns: time_s,event,args, where event and args are
//   move X Y | press [BUTTON] [MODIFIER...] | release [BUTTON] | wheel CLICKS [MODIFIER...] | key NAME | drop FILE |
//   click ADDRESS | close
// BUTTON is left (default), middle or right; MODIFIER shift, control or alt; NAME as parse_keys() reads it; ADDRESS of
// a button in the panel of devices: Devices/PROBE/Arm, Devices/Stop all. Times [s] ascend and count from the first
// frame.
class InputScript {
 public:
  static constexpr double kLongestPause = 0.5;  // [s]
  static Result<InputScript> load(const std::string& file);
  // Appends events due at `now` [s]. Time starts at the first call; a pause between two calls counts for at most
  // kLongestPause, so that opening a level delays the script.
  void take(double now, std::vector<InputEvent>& events);

 private:
  struct Row {
    double time;
    InputEvent event;
  };
  std::vector<Row> rows_;
  std::size_t next_ = 0;
  std::optional<double> last_;  // [s] `now` of the last call
  double time_ = 0.0;           // [s] on the script's clock
};

}  // namespace pliant
