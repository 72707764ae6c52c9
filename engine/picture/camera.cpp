#include <cmath>

#include "engine/session_parts.h"
#include "pliant/picture.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/renderer.h"

namespace pliant {
namespace {

constexpr int kMostPixels = 16384;  // wide or high

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check(const View& view, int width, int height) {
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
    return Error{"Camera", "the picture's size must be between 1 and 16384 pixels"};
  if (!finite(view.eye) || !finite(view.target) || !finite(view.up) || !(view.yfov > 0.01f && view.yfov < 3.1f))
    return Error{"Camera", "the view must be finite, and its yfov between 0.01 and 3.1"};
  const dvec3 along = view.target - view.eye;
  if (!(length(cross(along, view.up)) > 1e-9 * length(along) * length(view.up)))
    return Error{"Camera", "the view has no direction; eye and target must differ, and up must not be along them"};
  return Done{};
}

}  // namespace

// The session's view hands every snapshot that it takes to the renderer as well.
struct Camera::Parts {
  Session::Parts* session = nullptr;
  std::weak_ptr<int> run;  // of the session
  std::unique_ptr<HeadlessContext> context;
  std::unique_ptr<Renderer> renderer;

  ~Parts() {
    if (run.expired()) return;
    session->view.seen = {};
    session->view.soft_seen = {};
  }
  Status ready() {
    if (run.expired()) return Error{"Camera", "its session has been restarted or has ended; make a new camera"};
    if (context) context->make_current();
    session->look();
    return Done{};
  }
  static Result<Camera> make(Session& session, std::unique_ptr<HeadlessContext> context);
};

Result<Camera> Camera::Parts::make(Session& session, std::unique_ptr<HeadlessContext> context) {
  Session::Parts& of = *session.parts_;
  if (Status s = of.stand_still("Camera"); !s) return s.error();
  if (of.ended) return Error{"Camera", std::string(of.ended) + "; call Session::restart() first"};
  if (of.view.seen) return Error{"Camera", "the session has a camera; let it go first"};
  auto parts = std::make_unique<Parts>();
  parts->context = std::move(context);
  of.look();
  auto renderer = Renderer::create(of.world);
  if (!renderer) return renderer.error();
  parts->renderer = std::move(renderer).value();
  parts->session = &of;
  parts->run = of.run;
  Renderer* const to = parts->renderer.get();
  of.view.seen = [to](const Snapshot& snapshot) { to->update(snapshot); };
  of.view.soft_seen = [to](const SoftSnapshot& snapshot) { to->update(snapshot); };
  return Camera(std::move(parts));
}

Camera::Camera(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Camera::Camera(Camera&&) noexcept = default;
Camera& Camera::operator=(Camera&&) noexcept = default;
Camera::~Camera() = default;

Result<Camera> Camera::headless(Session& session) {
  auto context = HeadlessContext::create();
  if (!context) return context.error();
  return Parts::make(session, std::move(context).value());
}

Result<Camera> Camera::in_current_context(Session& session) {
  return Parts::make(session, nullptr);
}

View Camera::view() const {
  if (parts_->run.expired()) return {};
  const Viewpoint at = default_viewpoint(parts_->session->world);
  return {at.eye, at.target, at.up, at.yfov};
}

Result<Picture> Camera::picture(const View& view, int width, int height) {
  if (Status s = check(view, width, height); !s) return s.error();
  if (Status s = parts_->ready(); !s) return s.error();
  Image image = parts_->renderer->picture({view.eye, view.target, view.up, view.yfov}, width, height);
  return Picture{static_cast<int>(image.width), static_cast<int>(image.height), std::move(image.rgba)};
}

Status Camera::draw(const View& view, unsigned framebuffer, int width, int height) {
  if (Status s = check(view, width, height); !s) return s;
  if (Status s = parts_->ready(); !s) return s;
  parts_->renderer->draw({view.eye, view.target, view.up, view.yfov}, framebuffer, width, height);
  return Done{};
}

}  // namespace pliant
