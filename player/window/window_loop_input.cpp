#include <cmath>

#include "lab/console/exit.h"
#include "player/window/window_loop.h"
#include "runtime/printable.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

constexpr double kSamePlace = 2.0;    // [pixel]
constexpr double kPressWithin = 3.0;  // [s] for which a script waits for its widget

}  // namespace

void WindowLoop::say(const std::string& sentence, bool error) {
  state_.message = printable(sentence);
  state_.message_is_error = error;
  said_at_ = seconds_;
}

// Restarts the level with its new permissions.
void WindowLoop::answer_question(bool allowed) {
  if (state_.question.empty()) return;
  state_.question.clear();
  if (!allowed) return;
  if (const Status kept = s_.allow(); !kept) say(kept.error().message(), true);
  open(s_.level);
}

void WindowLoop::open(const std::string& file) {
  if (opening_.valid()) return;
  say("opening " + file, false);
  opening_ = std::async(std::launch::async, s_.open, file);
}

void WindowLoop::look_for_opened() {
  if (!opening_.valid() || opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    if (const std::optional<Error> wrong = opening_.get())
      say(wrong->message(), true);
    else
      figures_.opened = true;
  } catch (const std::exception& error) {  // a file that is too large must not end the run
    say(explain(error).message(), true);
  }
}

void WindowLoop::press(const InputEvent& event) {
  if (drag_ != Drag::kNone) return;
  dragging_ = event.button;
  if (event.button == MouseButton::kMiddle || (event.button == MouseButton::kLeft && (event.modifiers & kShift))) {
    drag_ = wants_mouse_ ? Drag::kNone : Drag::kPan;
  } else if (event.button == MouseButton::kRight || (event.modifiers & kAlt)) {
    drag_ = wants_mouse_ ? Drag::kNone : Drag::kOrbit;
  } else {
    drag_ = Drag::kAsked;
    decides_ = questions_ + 1;
    wants_pull_ = event.modifiers & kControl;
    pressed_x_ = cursor_.x();
    pressed_y_ = cursor_.y();
    // If the mouse has rested here, the answer is already known.
    const auto here = [&](const PickQuestion& q) {
      return std::hypot(q.x - pressed_x_, q.y - pressed_y_) < kSamePlace;
    };
    if (answer_ && here(answer_->question)) decide();
  }
}

// Decides what was pressed: a panel, a touchable object, the tool, or nothing, which orbits the view.
void WindowLoop::decide() {
  if (wants_mouse_)
    drag_ = Drag::kNone;
  else
    drag_ = hand_.press(wants_pull_, tool_at_) == MouseHand::Grip::kNone ? Drag::kOrbit : Drag::kHand;
}

void WindowLoop::release() {
  drag_ = Drag::kNone;
  hand_.release();
}

void WindowLoop::move(const InputEvent& event) {
  const double dx = event.x - mouse_.x, dy = event.y - mouse_.y;
  if (drag_ == Drag::kOrbit) camera_.orbit(dx, dy, s_.window.height());
  if (drag_ == Drag::kPan) camera_.pan(dx, dy, s_.window.height());
  mouse_.x = event.x;
  mouse_.y = event.y;
  cursor_.move_to(event.x, event.y);
  pointed_ = true;
}

void WindowLoop::wheel(const InputEvent& event) {
  mouse_.wheel += event.y;
  if (wants_mouse_) return;
  if (drag_ == Drag::kHand) {
    hand_.wheel(event.y, camera_.viewpoint());
  } else if ((event.modifiers & kControl) && hand_.has_probe()) {
    hand_.stand(event.y > 0 ? 1 : -1);
  } else {
    camera_.zoom(event.y);
  }
}

void WindowLoop::emergency_stop() {
  if (!s_.devices) return;
  s_.devices->stop_all();
  state_.figures = true;
  state_.show_devices = true;
  say("emergency stop: no device has force until it is armed in the panel", false);
}

// Emulates a user: once a picture shows the widget, the mouse is moved there for one picture, and the button is down in
// the next.
void WindowLoop::press_widgets() {
  if (wanted_widget_.empty()) return;
  for (const ui::Place& place : widgets_) {
    if (place.address != wanted_widget_) continue;
    const double x = 0.5 * static_cast<double>(place.low.x + place.high.x),
                 y = 0.5 * static_cast<double>(place.low.y + place.high.y);
    mouse_.down[0] = std::hypot(mouse_.x - x, mouse_.y - y) < kSamePlace && wants_mouse_;
    mouse_.x = x;
    mouse_.y = y;
    if (mouse_.down[0]) wanted_widget_.clear();
    return;
  }
  if (seconds_ - wanted_since_ < kPressWithin) return;
  note("the script presses `" + wanted_widget_ + "`, which is not there");
  wanted_widget_.clear();
}

void WindowLoop::key(int key) {
  const KeyRow* const row = window_key(key);
  if (!row) return;
  const std::string_view id = row->id;
  for (const Switch& each : switches())
    if (id == each.id && each.of) options_.*each.of = !(options_.*each.of);
  if (id == "view.height") options_.tint_height = options_.tint_height > 0 ? 0.0f : tint_;
  if (id == "view.frame") camera_.frame();
  if (id == "view.home") camera_.home();
  if (id == "view.front") camera_.look_from(0, 0);
  if (id == "view.right") camera_.look_from(glm::half_pi<double>(), 0);
  if (id == "view.top") camera_.look_from(0, glm::half_pi<double>());
  if (id == "view.figures") state_.figures = !state_.figures;
  if (id == "view.devices") {
    state_.show_devices = !state_.show_devices;
    state_.figures |= state_.show_devices;
  }
  if (id == "view.levels") {
    state_.panel.shown = !state_.panel.shown;
    state_.figures |= state_.panel.shown;
  }
  if (id == "play.toggle") touch_->pause(!touch_->paused());
  if (id == "play.restart") open(s_.level);
  if (id == "play.mouse" && !holdable_.empty())
    hold(state_.panel.holds ? (*state_.panel.holds + 1) % holdable_.size() : 0);
  if (id == "file.screenshot") ++screenshots_;
  if (id == "help.keys") state_.help = !state_.help;
  if (id == "file.close") {
    close_ |= !state_.help;
    state_.help = false;
  }
}

void WindowLoop::handle(const InputEvent& event) {
  switch (event.kind) {
    case InputKind::kMove:
      move(event);
      break;
    case InputKind::kPress:
      mouse_.down[static_cast<std::size_t>(event.button)] = down_[static_cast<std::size_t>(event.button)] = true;
      press(event);
      break;
    case InputKind::kRelease:
      down_[static_cast<std::size_t>(event.button)] = false;  // mouse_.down is cleared after a picture has seen it
      if (event.button == dragging_) release();
      break;
    case InputKind::kWheel:
      wheel(event);
      break;
    case InputKind::kKey:
      if (event.repeated) break;
      if (!s_.stop_keys.empty() && keys_text(event.key, event.modifiers) == s_.stop_keys)
        emergency_stop();
      else
        key(event.key);
      break;
    case InputKind::kWidget:
      wanted_widget_ = event.file;
      wanted_since_ = seconds_;
      break;
    case InputKind::kKeyUp:
    case InputKind::kText:
    case InputKind::kFocus:
      break;
    case InputKind::kDrop:
      open(event.file);
      break;
    case InputKind::kClose:
      close_ = true;
      break;
  }
}

}  // namespace pliant
