#include "editor/ui/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace pliant::ui {
namespace {

bool is_modifier(int key) {
  return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

// Produces a character: its order among commands is that of the character.
bool leaves_character(const InputEvent& event) {
  return event.key >= GLFW_KEY_SPACE && event.key <= GLFW_KEY_GRAVE_ACCENT &&
         (event.modifiers & (kControl | kAlt | kSuper)) == 0;
}

// Events taken for this frame so far.
struct Taken {
  bool moved = false, button = false, wheel = false, text = false, command = false, plain = false, apart = false;
  std::vector<int> went_down, went_up;

  bool pointer() const { return moved || button || wheel; }
  bool keyboard() const { return text || command || plain; }
  bool any() const { return pointer() || keyboard() || apart || !went_down.empty() || !went_up.empty(); }
  static bool holds(const std::vector<int>& keys, int key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }
};

// True: `event` must wait for the next frame to keep the order.
bool waits(const InputEvent& event, const Taken& taken, bool typing) {
  if (taken.apart) return true;
  switch (event.kind) {
    case InputKind::kMove:
      return taken.button || taken.wheel || taken.keyboard();
    case InputKind::kPress:
    case InputKind::kRelease:  // picking is known a frame after the mouse has moved there
      return taken.pointer() || taken.keyboard();
    case InputKind::kWheel:
      return taken.moved || taken.button || taken.keyboard();
    case InputKind::kText:
      return taken.pointer() || taken.command;
    case InputKind::kKeyUp:
      if (typing && leaves_character(event)) return false;
      return Taken::holds(taken.went_down, event.key) || (is_modifier(event.key) && (taken.command || taken.plain));
    case InputKind::kKey:
      if (event.repeated || (typing && leaves_character(event))) return taken.command || taken.pointer();
      if (Taken::holds(taken.went_down, event.key) || Taken::holds(taken.went_up, event.key)) return true;
      if (is_modifier(event.key)) return taken.command;
      if (taken.pointer() || taken.command) return true;
      // Without a text field the key may be a tool's, and what follows is for that tool.
      return taken.text || taken.plain;
    case InputKind::kFocus:
    case InputKind::kDrop:
    case InputKind::kClose:
    case InputKind::kWidget:
      return taken.any();
  }
  return false;
}

void note(const InputEvent& event, Taken& taken) {
  switch (event.kind) {
    case InputKind::kMove:
      taken.moved = true;
      break;
    case InputKind::kPress:
    case InputKind::kRelease:
      taken.button = true;
      break;
    case InputKind::kWheel:
      taken.wheel = true;
      break;
    case InputKind::kText:
      taken.text = true;
      break;
    case InputKind::kKeyUp:
      taken.went_up.push_back(event.key);
      break;
    case InputKind::kKey:
      if (event.repeated) break;
      taken.went_down.push_back(event.key);
      if (!is_modifier(event.key)) (leaves_character(event) ? taken.plain : taken.command) = true;
      break;
    case InputKind::kFocus:
    case InputKind::kDrop:
    case InputKind::kClose:
    case InputKind::kWidget:
      taken.apart = true;
      break;
  }
}

}  // namespace

void InputQueue::add(std::span<const InputEvent> events, double now) {
  for (const InputEvent& event : events) waiting_.push_back({event, now});
}

std::vector<ArrivedInput> InputQueue::take(bool typing) {
  std::vector<ArrivedInput> out;
  Taken taken;
  while (!waiting_.empty() && !waits(waiting_.front().event, taken, typing)) {
    note(waiting_.front().event, taken);
    out.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  return out;
}

}  // namespace pliant::ui
