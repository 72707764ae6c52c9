// What a hand does to a window: the same events whether they come from GLFW or from a file.
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
enum class MouseButton : std::uint8_t { kLeft, kMiddle, kRight };
enum ModifierBit : std::uint8_t { kShift = 1, kControl = 2, kAlt = 4, kSuper = 8 };

struct InputEvent {
  InputKind kind = InputKind::kMove;
  double x = 0, y = 0;  // [pixel] from the upper left corner; of a wheel, y: clicks, > 0 away from the hand
  MouseButton button = MouseButton::kLeft;
  int key = 0;                          // as GLFW numbers them; of kText: the code point
  bool repeated = false;                // of kKey: held down
  std::uint8_t modifiers = 0;           // ModifierBit
  std::string file;                     // that was dropped first; of kWidget, which only a script has: its address
  std::vector<std::string> files = {};  // all that were dropped
};

// Events from a file, for trying the window without a hand. Columns: time_s,event,args, where event and args are
//   move X Y | press [BUTTON] [MODIFIER...] | release [BUTTON] | wheel CLICKS [MODIFIER...] | key NAME | drop FILE |
//   click ADDRESS | close
// BUTTON is left (default), middle or right; MODIFIER shift, control or alt; NAME a letter or digit, F1 to F12, Tab,
// Esc, Space or Home; ADDRESS of a button in the panel of devices: Devices/PROBE/Arm, Devices/Stop all. Times [s]
// ascend and count from the first picture.
class InputScript {
 public:
  static constexpr double kLongestPause = 0.5;  // [s]
  static Result<InputScript> load(const std::string& file);
  // Appends what is due at `now` [s] and was not given yet. Time begins with the first call, and a pause between two
  // calls counts for at most kLongestPause: while a level opens, a hand would wait too.
  void take(double now, std::vector<InputEvent>& events);

 private:
  struct Row {
    double time;
    InputEvent event;
  };
  std::vector<Row> rows_;
  std::size_t next_ = 0;
  std::optional<double> last_;  // [s] `now` of the last call
  double time_ = 0.0;           // [s] of the script
};

}  // namespace pliant
