// Pictures of a Session by the renderer of the command: materials, bump maps, environment maps, reflection, refraction,
// shadows (component `visual`). A program with its own renderer uses Session::stream instead.
//
//   auto pictures = pliant::Pictures::headless(*session);
//   auto picture = pictures->picture(pictures->view(), 1280, 720);
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pliant/picture_quality.h"
#include "pliant/session.h"

namespace pliant {

// The camera of a picture.
struct PictureView {
  dvec3 eye{0, 0, 1};  // [m] world
  dvec3 target{0};     // [m]
  dvec3 up{0, 1, 0};
  float yfov = 0.7f;  // [rad] vertical field of view
};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, four bytes per pixel, rows from top to bottom
};

// Belongs to the thread that owns the session, and to one run of it. After Session::restart() or the session's end
// every call is an error, and a new object is needed. Create it before start(); pictures may be taken while the clocks
// run.
class Pictures {
 public:
  // With its own context and no window (EGL): on the GPU, or by Mesa's software renderer.
  static Result<Pictures> headless(Session& session);
  // Uses the OpenGL 4.5 core or ES 3.0 context that is current on this thread, here and in every later call.
  static Result<Pictures> in_current_context(Session& session);
  Pictures(Pictures&&) noexcept;
  Pictures& operator=(Pictures&&) noexcept;
  ~Pictures();

  // The level's camera, or one that shows every deformable surface.
  PictureView view() const;
  // Of all later pictures; high at first.
  void set_quality(PictureQuality quality);
  // At most 16384 pixels wide and high.
  Result<Picture> picture(const PictureView& view, int width, int height);
  // Draws into a framebuffer of the current context; 0 is the window's.
  Status draw(const PictureView& view, unsigned framebuffer, int width, int height);

 private:
  struct Parts;
  explicit Pictures(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace pliant
