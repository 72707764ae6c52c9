#include <cmath>

#include "engine/session/session_run.h"
#include "pliant/picture.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/renderer.h"

namespace pliant {
namespace {

constexpr int kMostPixels = 16384;  // wide or high

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check(const PictureView& view, int width, int height) {
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
    return Error{"Pictures", "the picture's size must be between 1 and 16384 pixels"};
  if (!finite(view.eye) || !finite(view.target) || !finite(view.up) || !(view.yfov > 0.01f && view.yfov < 3.1f))
    return Error{"Pictures", "the view must be finite, and its yfov between 0.01 and 3.1"};
  const dvec3 along = view.target - view.eye;
  if (!(length(cross(along, view.up)) > 1e-9 * length(along) * length(view.up)))
    return Error{"Pictures", "the view has no direction", "eye and target must differ, and up must not be along them"};
  return Done{};
}

}  // namespace

// The session's view passes every snapshot on to the renderer.
struct Pictures::Parts {
  SessionRun* session = nullptr;
  std::weak_ptr<int> session_alive;
  std::unique_ptr<HeadlessContext> context;
  std::unique_ptr<Renderer> renderer;

  ~Parts() {
    if (context) context->make_current();
    renderer.reset();
    if (session_alive.expired()) return;
    session->view.seen = {};
    session->view.soft_seen = {};
  }
  Status ready() {
    if (session_alive.expired())
      return Error{"Pictures", "its session has been restarted or has ended", "make Pictures anew"};
    if (context) context->make_current();
    session->look();
    return Done{};
  }
  static Status may_make(const Session& session);
  static Result<Pictures> make(Session& session, std::unique_ptr<HeadlessContext> context);
};

Status Pictures::Parts::may_make(const Session& session) {
  const SessionRun& of = SessionRun::of(session);
  if (Status s = of.stand_still("Pictures"); !s) return s;
  if (of.ended) return Error{"Pictures", std::string(of.ended), "call Session::restart() first"};
  if (of.view.seen) return Error{"Pictures", "the session has Pictures already", "let them go first"};
  return Done{};
}

Result<Pictures> Pictures::Parts::make(Session& session, std::unique_ptr<HeadlessContext> context) {
  SessionRun& of = SessionRun::of(session);
  auto parts = std::make_unique<Parts>();
  parts->context = std::move(context);
  of.look();
  auto renderer = Renderer::create(of.world);
  if (!renderer) return renderer.error();
  parts->renderer = std::move(renderer).value();
  parts->session = &of;
  parts->session_alive = of.alive;
  Renderer* const to = parts->renderer.get();
  of.view.seen = [to](const Snapshot& snapshot) { to->update(snapshot); };
  of.view.soft_seen = [to](const SoftSnapshot& snapshot) { to->update(snapshot); };
  if (of.view.has_soft()) to->update(of.world.soft_snapshots->read());  // taken already
  return Pictures(std::move(parts));
}

Pictures::Pictures(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Pictures::Pictures(Pictures&&) noexcept = default;
Pictures& Pictures::operator=(Pictures&&) noexcept = default;
Pictures::~Pictures() = default;

Result<Pictures> Pictures::headless(Session& session) {
  if (Status s = Parts::may_make(session); !s) return s.error();
  auto context = HeadlessContext::create();
  if (!context) return context.error();
  return Parts::make(session, std::move(context).value());
}

Result<Pictures> Pictures::in_current_context(Session& session) {
  if (Status s = Parts::may_make(session); !s) return s.error();
  return Parts::make(session, nullptr);
}

PictureView Pictures::view() const {
  if (parts_->session_alive.expired()) return {};
  const Viewpoint at = default_viewpoint(parts_->session->world);
  return {at.eye, at.target, at.up, at.yfov};
}

void Pictures::set_quality(PictureQuality quality) {
  parts_->renderer->options().quality = quality;
}

Result<Picture> Pictures::picture(const PictureView& view, int width, int height) {
  if (Status s = check(view, width, height); !s) return s.error();
  if (Status s = parts_->ready(); !s) return s.error();
  Image image = parts_->renderer->picture({view.eye, view.target, view.up, view.yfov}, width, height);
  return Picture{static_cast<int>(image.width), static_cast<int>(image.height), std::move(image.rgba)};
}

Status Pictures::draw(const PictureView& view, unsigned framebuffer, int width, int height) {
  if (Status s = check(view, width, height); !s) return s;
  if (Status s = parts_->ready(); !s) return s;
  parts_->renderer->draw({view.eye, view.target, view.up, view.yfov}, framebuffer, width, height);
  return Done{};
}

}  // namespace pliant
