// The module `_window`: a window on the display, seen through view_window.h; for pliant.view.
#include <pybind11/pybind11.h>

#include <array>
#include <utility>
#include <vector>

#include "python/src/view_window.h"
#include "viewer/hand/camera_control.h"
#include "viewer/window/window.h"

namespace pliant_python {
namespace {

using pliant::InputEvent;
using pliant::InputKind;
using pliant::MouseButton;

constexpr int kHomeKey = 268;  // GLFW's number

// The left button turns the camera, the others (or with Shift) move it, the wheel zooms, Home returns.
class CameraWindow final : public ViewWindow {
 public:
  explicit CameraWindow(std::unique_ptr<pliant::Window> window) : window_(std::move(window)) {}

  void show(const pliant::PictureView& home, const pliant::Bounds& bounds, const std::string& title) override {
    pliant::Box box;
    box.add(pliant::Box{pliant::vec3(bounds.min), pliant::vec3(bounds.max)});
    camera_ = pliant::CameraControl({home.eye, home.target, home.up, home.yfov}, box);
    window_->show(title);
  }

  bool poll() override {
    events_.clear();
    window_->poll(events_, 0.0);
    for (const InputEvent& event : events_) {
      if (event.kind == InputKind::kClose) return false;
      handle(event);
    }
    return true;
  }

  pliant::PictureView view(double dt) override {
    camera_.update(dt);
    const pliant::Viewpoint at = camera_.viewpoint();
    return {at.eye, at.target, at.up, at.yfov};
  }

  int width() const override { return window_->width(); }
  int height() const override { return window_->height(); }
  void present() override { window_->present(); }
  bool lost(pliant::Error& why) const override {
    if (pliant::Window::lost()) why = pliant::Window::loss();
    return pliant::Window::lost();
  }

 private:
  void handle(const InputEvent& event) {
    const bool press = event.kind == InputKind::kPress;
    if (press || event.kind == InputKind::kRelease) {
      down_[static_cast<std::size_t>(event.button)] = press;
      pans_ = press && (event.button != MouseButton::kLeft || (event.modifiers & pliant::kShift));
    } else if (event.kind == InputKind::kWheel) {
      camera_.zoom(event.y);
    } else if (event.kind == InputKind::kKey && event.key == kHomeKey) {
      camera_.home();
    } else if (event.kind == InputKind::kMove) {
      const double dx = event.x - std::exchange(x_, event.x), dy = event.y - std::exchange(y_, event.y);
      if (!down_[0] && !down_[1] && !down_[2]) return;
      pans_ ? camera_.pan(dx, dy, height()) : camera_.orbit(dx, dy, height());
    }
  }

  std::unique_ptr<pliant::Window> window_;
  pliant::CameraControl camera_ = pliant::CameraControl::before({});
  std::vector<InputEvent> events_;
  std::array<bool, 3> down_{};  // of each button
  bool pans_ = false;
  double x_ = 0, y_ = 0;  // [pixel] of the pointer
};

std::unique_ptr<ViewWindow> open_window(int width, int height, pliant::Error& why) {
  auto window = pliant::Window::create(width, height, ", or use Session.render()");
  if (window) return std::make_unique<CameraWindow>(std::move(window).value());
  why = window.error().at("view");
  return nullptr;
}

}  // namespace
}  // namespace pliant_python

PYBIND11_MODULE(_window, module) {
  module.doc() = "The window of pliant.view.";
  const pliant_python::OpenViewWindow open = &pliant_python::open_window;
  module.attr("_open") = pybind11::capsule(reinterpret_cast<void*>(open), "pliant._window.open");
}
