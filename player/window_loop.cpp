#include "player/window_loop.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "content/file_io.h"
#include "content/image.h"
#include "player/exit.h"
#include "player/interrupt.h"
#include "systems/device/mouse.h"
#include "systems/visual/png.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr double kMessageTime = 8.0;    // [s]
constexpr float kTintShare = 0.2f;      // [1] of the reach: a height that is coloured fully
constexpr double kSlowestFrame = 0.25;  // [s] beyond this, motion does not catch up
constexpr double kSmoothing = 0.1;      // [1] of the newest frame in the shown rate
constexpr double kSlowDraw = 70.0;      // [ms] a card (or a processor in its stead) that needs longer draws coarser,
constexpr double kFastDraw = 20.0;      // [ms] and one that needs less draws finer, up to every pixel
constexpr double kWantedDraw = 40.0;    // [ms]
constexpr double kLongestDraw = 120.0;  // [ms] for a screenshot
constexpr double kCoarsest = 0.25;      // [1]

// The radius of the probe that the mouse moves, if there is one. [m]
std::optional<double> mouse_radius(const World& world) {
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const HapticDevice* device = world.registry.find<HapticDevice>(probe.device);
    if (device && device->driver == Driver::kMouse) return probe.radius;
  }
  return {};
}

float tint_of(const World& world) {
  double reach = 0.0;
  for (auto [entity, deformable] : world.registry.view<Deformable>()) reach = std::max(reach, deformable.reach);
  return reach > 0 ? kTintShare * static_cast<float>(reach) : 0.01f;
}

// What stands in the window, with everything over it.
Image read_back(int width, int height) {
  Image image;
  image.name = "screenshot";
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  const std::size_t row = std::size_t{4} * image.width;
  std::vector<std::uint8_t> bottom_up(row * image.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  for (std::size_t y = image.height; y-- > 0;)
    image.rgba.insert(image.rgba.end(), bottom_up.begin() + static_cast<std::ptrdiff_t>(y * row),
                      bottom_up.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;  // a window has nothing behind it
  return image;
}

}  // namespace

WindowLoop::WindowLoop(WindowSession& session, Renderer& renderer)
    : s_(session),
      renderer_(renderer),
      camera_(default_viewpoint(session.world), drawn_box(session.world, false)),
      radius_(mouse_radius(session.world)),
      pointer_(session.world, radius_.value_or(0.0)),
      overlay_(session.window.scale()),
      tint_(tint_of(session.world)) {
  state_.title = session.world.name;
  state_.rate_wanted = session.rate;
  for (std::size_t i = 0; i < session.journal.probes().size(); ++i) {
    const ProbeSummary& summary = session.keeper.summaries()[i];
    state_.probes.push_back(
        {summary.name, summary.source, session.world.registry.get<Probe>(session.journal.probes()[i]).color, {}});
    if (summary.source == "mouse") mouse_probe_ = i;
  }
  mouse_.x = 0.5 * session.window.width();
  mouse_.y = 0.5 * session.window.height();
  probe_at_ = pointer_.start(camera_.viewpoint());
  if (radius_) add_mouse(session.world, probe_at_);
}

Ray WindowLoop::ray() const {
  return ray_through(camera_.viewpoint(), cursor_.x(), cursor_.y(), s_.window.width(), s_.window.height());
}

// Where the probe should be goes to the touch clock every picture, moved or not: silence means that nobody is there.
void WindowLoop::point(double dt) {
  const double force = mouse_probe_ ? state_.probes[*mouse_probe_].history.newest().force : 0.0;
  cursor_.update(drag_ == Drag::kPress, force, dt);
  if (!radius_) return;
  if (pointed_ && drag_ != Drag::kOrbit && drag_ != Drag::kPan) probe_at_ = pointer_.update(ray(), dt);
  s_.world.mouse->samples.write() = {probe_at_, pointer_.free()};
  s_.world.mouse->samples.publish();
  state_.cursor = pointed_ && drag_ != Drag::kOrbit && drag_ != Drag::kPan;
  state_.cursor_x = cursor_.x();
  state_.cursor_y = cursor_.y();
  state_.cursor_force = force;
  state_.pressing = pointer_.pressing();
  s_.window.hide_cursor(state_.cursor && !overlay_.wants_mouse());
}

void WindowLoop::keep() {
  s_.keeper.keep(s_.journal);
  for (const TickRow& row : s_.keeper.latest()) state_.probes[row.probe].history.add(row);
}

void WindowLoop::take_snapshots() {
  while (s_.world.snapshots->acquire()) {
    const Snapshot& snapshot = s_.world.snapshots->read();
    renderer_.update(snapshot);
    state_.awake_vertices = 0;
    for (const ObjectSnapshot& object : snapshot.objects) state_.awake_vertices += object.awake_vertices;
  }
  if (s_.world.soft_snapshots && s_.world.soft_snapshots->acquire()) renderer_.update(s_.world.soft_snapshots->read());
}

// Pictures that were asked for; a slow card takes fewer.
Status WindowLoop::stage_frames() {
  const std::uint64_t reached = touch_->now();
  if (next_frame_ >= s_.frame_ticks.size() || s_.frame_ticks[next_frame_] > reached) return Done{};
  while (next_frame_ < s_.frame_ticks.size() && s_.frame_ticks[next_frame_] <= reached) ++next_frame_;
  const Image image = renderer_.picture(camera_.viewpoint(), s_.frame_width, s_.frame_height);
  return write_file(s_.out.stage(fmt::format("frame-{:04d}.png", figures_.pictures++)),
                    encode_png(image.width, image.height, image.rgba.data()));
}

// At once, and beside what is already there: a hand asked for it.
void WindowLoop::screenshot() {
  std::filesystem::path file;
  std::error_code ignored;
  for (int i = 1; file.empty() || std::filesystem::exists(file, ignored); ++i)
    file = s_.out.path() / fmt::format("screenshot-{:03d}.png", i);
  const Status written = write_png(read_back(s_.window.width(), s_.window.height()), file);
  if (written) {
    say(file.string(), false);
  } else {
    say(written.error().message(), true);
  }
}

// A picture that comes late is worse than a coarse one, and after kMouseSilence
// without a word from here the touch clock lets go.
void WindowLoop::choose_share(double draw_ms) {
  if (draw_ms < kSlowDraw && (draw_ms > kFastDraw || share_ == 1.0)) return;
  share_ = std::clamp(share_ * std::sqrt(kWantedDraw / std::max(draw_ms, 1.0)), kCoarsest, 1.0);
  if (share_ > 0.9) share_ = 1.0;
}

FrameStats WindowLoop::draw_scene(double share) {
  const int width = s_.window.width(), height = s_.window.height();
  if (share == 1.0) return renderer_.draw(camera_.viewpoint(), 0, width, height);
  const int w = std::max(1, static_cast<int>(width * share)), h = std::max(1, static_cast<int>(height * share));
  if (!coarse_.has_size(w, h)) coarse_ = gpu::Framebuffer(w, h, 0);
  const FrameStats stats = renderer_.draw(camera_.viewpoint(), coarse_.id(), w, h);
  glDisable(GL_FRAMEBUFFER_SRGB);  // encoded bytes to encoded bytes
  glBlitNamedFramebuffer(coarse_.id(), 0, 0, 0, w, h, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  return stats;
}

Status WindowLoop::draw(double dt) {
  const int width = s_.window.width(), height = s_.window.height();
  if (const Status staged = stage_frames(); !staged) return staged;
  // A picture that stays is worth some time, but not the force of a hand that presses.
  const double finer = share_ * std::sqrt(kLongestDraw / std::max(state_.draw_ms, 1.0));
  const FrameStats stats = draw_scene(wants_screenshot_ ? std::clamp(finer, share_, 1.0) : share_);
  if (!wants_screenshot_) choose_share(stats.draw_ms);
  figures_.frames.add(stats);
  state_.upload_bytes = stats.upload_bytes;
  state_.draw_ms = stats.draw_ms;
  state_.touch = touch_->figures();
  state_.paused = touch_->paused();
  frame_time_ = frame_time_ > 0 ? frame_time_ + kSmoothing * (dt - frame_time_) : dt;
  state_.frames_per_second = frame_time_ > 0 ? 1 / frame_time_ : 0;
  state_.resolution = share_;
  if (seconds_ - said_at_ > kMessageTime) state_.message.clear();
  overlay_.draw(state_, renderer_.options(), tint_, mouse_, width, height, dt);
  mouse_.wheel = 0;
  if (wants_screenshot_) screenshot();
  wants_screenshot_ = false;
  s_.window.present();
  return Done{};
}

Result<WindowFigures> WindowLoop::run() {
  const Interrupt interrupt;
  std::vector<InputEvent> events;
  // Pictures before the clock starts: whatever the driver does once, it does now, and how fast it draws is known.
  for (int i = 0; i < 3; ++i) {
    const FrameStats stats = draw_scene(share_);
    if (i > 0) choose_share(stats.draw_ms);
  }
  s_.window.show(s_.world.name + " - Pliant");
  touch_.emplace(s_.world, s_.schedule, s_.journal, s_.rate, s_.ticks);
  const std::uint64_t start = now_ns();
  Status status = Done{};
  while (!close_ && !figures_.opened && !touch_->done() && !interrupt.requested() && status) {
    const double now = static_cast<double>(now_ns() - start) * 1e-9, dt = now - seconds_;
    seconds_ = now;
    events.clear();
    s_.window.poll(events);
    s_.script.take(static_cast<double>(now_ns()) * 1e-9, events);
    for (const InputEvent& event : events) handle(event);
    camera_.update(std::min(dt, kSlowestFrame));
    keep();
    point(std::min(dt, kSlowestFrame));
    take_snapshots();
    look_for_opened();
    status = draw(dt);
  }
  touch_->stop();
  keep();
  if (opening_.valid()) opening_.wait();
  s_.window.hide_cursor(false);
  if (!touch_->has_priority()) note("the system does not grant SCHED_FIFO, so ticks may come late; see `ulimit -r`");
  figures_.overruns = touch_->overruns();
  if (!status) return status.error();
  return figures_;
}

Result<WindowFigures> run_window(WindowSession& session) {
  auto renderer = Renderer::create(session.world);
  if (!renderer) return renderer.error();
  WindowLoop loop(session, **renderer);
  return loop.run();
}

}  // namespace pliant
