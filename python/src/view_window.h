// The border between the modules `_pliant` and `_window`: a window on the display with a camera. They are apart because only
// `_window` needs GLFW, which a machine without a display may lack.
#pragma once

#include <pliant/picture.h>

#include <memory>
#include <string>

namespace pliant_python {

// Every call is made on the thread that opened it, with its OpenGL context current there.
class ViewWindow {
 public:
  virtual ~ViewWindow() = default;
  // Shows it. `home`: the initial camera; `bounds` [m] of the scene.
  virtual void show(const pliant::PictureView& home, const pliant::Bounds& bounds, const std::string& title) = 0;
  virtual bool poll() = 0;                          // handles the input so far; false: the user has closed it
  virtual pliant::PictureView view(double dt) = 0;  // the camera, dt [s] after the last call
  virtual int width() const = 0;                    // [pixel]
  virtual int height() const = 0;                   // [pixel]
  virtual void present() = 0;                       // shows the drawn picture; waits for vertical sync
  virtual bool lost(pliant::Error& why) const = 0;  // the display is gone
};

// Null: it cannot be opened, for `why`.
using OpenViewWindow = std::unique_ptr<ViewWindow> (*)(int width, int height, pliant::Error& why);

}  // namespace pliant_python
