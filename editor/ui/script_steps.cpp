// Steps of a script: the events of each, and what it waits for.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <sstream>

#include "editor/ui/script.h"
#include "editor/ui/script_words.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"
#include "viewer/window/keys.h"

namespace pliant::ui {
namespace {

constexpr int kLateFrames = 10;  // to wait for the target of a click

InputEvent event_at(InputKind kind, double x, double y, MouseButton button = MouseButton::kLeft,
                    std::uint8_t modifiers = 0) {
  InputEvent event;
  event.kind = kind;
  event.x = x;
  event.y = y;
  event.button = button;
  event.modifiers = modifiers;
  return event;
}

}  // namespace

Error Script::wrong(const Step& step, std::string what, std::string cure) const {
  return {fmt::format("{}:{}", file_, step.line), std::move(what), std::move(cure)};
}

void Script::key_events(const std::string& keys) {
  int key = 0;
  std::uint8_t modifiers = 0;
  if (!parse_keys(keys, key, modifiers)) return;
  InputEvent down;
  down.kind = InputKind::kKey;
  down.key = key;
  down.modifiers = modifiers;
  InputEvent up = down;
  up.kind = InputKind::kKeyUp;
  up.modifiers = 0;
  frames_.push_back({down});
  frames_.push_back({up});
}

void Script::text_events(const std::string& text) {
  for (const char* c = text.c_str(); *c != '\0';) {
    unsigned code_point = 0;
    c += std::max(1, ImTextCharFromUtf8(&code_point, c, nullptr));
    InputEvent event;
    event.kind = InputKind::kText;
    event.key = static_cast<int>(code_point);
    frames_.push_back({event});
  }
}

// The events of a press at `from`, and of a drag to `to`.
void Script::pointer_events(const Step& step, const Manner& m, Spot from, Spot to) {
  frames_.push_back({event_at(InputKind::kMove, from.first, from.second)});
  frames_.push_back({});
  if (step.verb == "move") return;
  if (m.twice) {  // as fast as a user, however slow the frames are
    const InputEvent down = event_at(InputKind::kPress, 0, 0, m.button, m.modifiers),
                     up = event_at(InputKind::kRelease, 0, 0, m.button, m.modifiers);
    frames_.push_back({down, up, down, up});
  } else {
    frames_.push_back({event_at(InputKind::kPress, 0, 0, m.button, m.modifiers)});
    if (step.verb == "press") return;
    if (step.verb == "drag") {
      const int steps = std::max(4, static_cast<int>(m.seconds * 40));
      for (int k = 1; k <= steps; ++k) {
        const double s = static_cast<double>(k) / steps;
        frames_.push_back({event_at(InputKind::kMove, from.first + s * (to.first - from.first),
                                    from.second + s * (to.second - from.second))});
      }
      frames_.push_back({});
    }
    frames_.push_back({event_at(InputKind::kRelease, 0, 0, m.button, m.modifiers)});
  }
}

Status Script::begin_press(const Step& step, bool& waits) {
  std::size_t i = 0;
  bool there = true;
  const auto from = place(leading_address(step.words, i), there, step.verb == "move" ? Need::kUncovered : Need::kPress);
  waits = !from && rest_ < kLateFrames;
  if (waits) return Done{};
  if (!from) return wrong(step, from.error());
  Spot to = *from;
  if (step.verb == "drag") {
    if (i >= step.words.size() || step.words[i] != "to")
      return wrong(step, "says no place to drag to", "write `drag A to B`");
    const auto target = place(leading_address(step.words, ++i), there, Need::kThere);
    if (!target) return wrong(step, target.error());
    to = *target;
  }
  pointer_events(step, manner_of({step.words.begin() + static_cast<std::ptrdiff_t>(i), step.words.end()}), *from, to);
  return Done{};
}

Status Script::begin_wheel(const Step& step) {
  bool there = true;
  if (step.words.size() < 2) return wrong(step, "says no clicks", "write `wheel Viewport 3`");
  const auto clicks = number_of(step.words.back());
  const auto from = place(step.rest.substr(0, step.rest.rfind(' ')), there, Need::kUncovered);
  if (!from) return wrong(step, from.error());
  if (!clicks) return wrong(step, "says no clicks", "write `wheel Viewport 3`");
  frames_.push_back({event_at(InputKind::kMove, from->first, from->second)});
  frames_.push_back({event_at(InputKind::kWheel, 0, *clicks)});
  return Done{};
}

Status Script::begin_set(const Step& step, bool& waits) {
  bool there = true;
  // The longest prefix that is a widget's address: names and values may both contain blanks.
  std::size_t last = step.rest.rfind(' ');
  if (last == std::string::npos) return wrong(step, "says no value", "write `set Inspector/stiffness 500`");
  for (std::size_t at = last; at != std::string::npos && at > 0; at = step.rest.rfind(' ', at - 1))
    if (find_widget(step.rest.substr(0, at))) {
      last = at;
      break;
    }
  const auto from = place(step.rest.substr(0, last), there, Need::kPress);
  waits = !from && rest_ < kLateFrames;
  if (waits) return Done{};
  if (!from) return wrong(step, from.error());
  frames_.push_back({event_at(InputKind::kMove, from->first, from->second)});
  frames_.push_back({});
  // Ctrl-click edits a number, and selects a text.
  InputEvent down = event_at(InputKind::kPress, 0, 0, MouseButton::kLeft, kControl);
  frames_.push_back({down});
  frames_.push_back({event_at(InputKind::kRelease, 0, 0, MouseButton::kLeft, kControl)});
  frames_.push_back({});
  key_events("Ctrl+A");
  text_events(step.rest.substr(last + 1));
  key_events("Enter");
  return Done{};
}

Status Script::begin_await(const Step& step, const Surroundings& now, bool& waits) {
  bool there = true;
  if (began_ < 0) began_ = now.now;
  std::string address = step.rest;
  double patience = kScriptPatience;
  if (const std::size_t last = address.rfind(' '); last != std::string::npos)
    if (const auto seconds = number_of(address.substr(last + 1))) {
      patience = *seconds;
      address.resize(last);
    }
  const auto found = find_widget(address);
  const auto seen = place(address, there, Need::kUncovered);
  waits = !seen || (found && !found->enabled);
  if (waits && now.now - began_ > patience)
    return seen ? wrong(step, "'" + address + "' stays off") : wrong(step, seen.error());
  return Done{};
}

Status Script::begin_expect(const Step& step, bool& waits) {
  bool there = true;
  const auto found = place(step.rest, there, Need::kUncovered);
  waits = (step.verb == "expect") != there && rest_ < kLateFrames;
  if (waits) return Done{};
  if ((step.verb == "expect") != there)
    return found ? wrong(step, "'" + step.rest + "' is there, and should not be") : wrong(step, found.error());
  return Done{};
}

void Script::begin_drop(const Step& step) {
  InputEvent event;
  event.kind = step.verb == "drop" ? InputKind::kDrop : InputKind::kClose;
  std::istringstream files(step.rest);
  for (std::string file; std::getline(files >> std::ws, file, '|');) {
    while (file.ends_with(' ')) file.pop_back();
    event.files.push_back(file);
  }
  frames_.push_back({event});
}

Status Script::begin(const Step& step, const Surroundings& now, bool& waits) {
  waits = false;
  if (step.verb == "click" || step.verb == "press" || step.verb == "move" || step.verb == "drag")
    return begin_press(step, waits);
  if (step.verb == "wheel") return begin_wheel(step);
  if (step.verb == "set") return begin_set(step, waits);
  if (step.verb == "await") return begin_await(step, now, waits);
  if (step.verb == "expect" || step.verb == "expect-no") return begin_expect(step, waits);
  if (step.verb == "release") {
    frames_.push_back({event_at(InputKind::kRelease, 0, 0, manner_of(step.words).button)});
    return Done{};
  }
  if (step.verb == "key") {
    int key = 0;
    std::uint8_t modifiers = 0;
    if (!parse_keys(step.rest, key, modifiers))
      return wrong(step, "'" + step.rest + "' is no key", "write, say, Ctrl+S");
    key_events(step.rest);
    return Done{};
  }
  if (step.verb == "type") {
    text_events(step.rest);
    return Done{};
  }
  if (step.verb == "wait") {
    if (began_ < 0) began_ = now.now;
    waits = now.now - began_ < number_of(step.rest).value_or(0.0);
    return Done{};
  }
  if (step.verb == "say") {
    if (!now.has_said(step.rest)) return wrong(step, "the console does not say '" + step.rest + "'");
    return Done{};
  }
  if (step.verb == "hear") {
    if (began_ < 0) began_ = now.now;
    waits = !now.has_said(step.rest);
    if (waits && now.now - began_ > kScriptPatience) return wrong(step, "the console does not say '" + step.rest + "'");
    return Done{};
  }
  if (step.verb == "figures") {
    now.figures(step.rest);
    return Done{};
  }
  if (step.verb == "felt") {
    const Status written = now.felt(step.rest);
    return written ? written : wrong(step, written.error().message());
  }
  if (step.verb == "screenshot") {
    now.screenshot(step.rest);
    frames_.push_back({});
    return Done{};
  }
  if (step.verb == "apart") {
    if (const std::string why = not_apart(); !why.empty()) return wrong(step, why);
    return Done{};
  }
  if (step.verb == "slow") {
    now.slow(number_of(step.rest).value_or(0.0));
    return Done{};
  }
  if (step.verb == "at-once" || step.verb == "now") {
    at_once_ = step.verb == "at-once";
    return Done{};
  }
  begin_drop(step);
  return Done{};
}

}  // namespace pliant::ui
