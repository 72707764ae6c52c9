#include "player/window/window_picture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "content/files/file_io.h"
#include "content/files/image.h"
#include "lab/console/exit.h"
#include "runtime/clock.h"
#include "viewer/picture/window_png.h"

namespace pliant {
namespace {

constexpr double kLongestDraw = 500.0;  // [ms] for a screenshot
}  // namespace

WindowPictures::WindowPictures(Window& window, World& world, Renderer& renderer)
    : window_(window), world_(world), renderer_(renderer), scale_(window.scale()) {
  window_.give_context();
  thread_ = std::thread([this] { run(); });
}

WindowPictures::~WindowPictures() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (!Window::lost()) window_.take_context();
}

void WindowPictures::begin(PictureOrder order) {
  const std::lock_guard lock(mutex_);
  ASSERT(!busy_);
  order_ = std::move(order);
  busy_ = true;
  began_ns_ = now_ns();
  changed_.notify_all();
}

bool WindowPictures::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

double WindowPictures::seconds() const {
  const std::lock_guard lock(mutex_);
  return busy_ ? static_cast<double>(now_ns() - began_ns_) * 1e-9 : 0.0;
}

const PictureDone& WindowPictures::done() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_; });
  return done_;
}

bool WindowPictures::wait(double seconds) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return !busy_; });
}

void WindowPictures::run() {
  try {
    window_.take_context();
    overlay_.emplace(scale_);
  } catch (...) {
    failure_ = std::current_exception();  // every picture fails with it
  }
  draw_when_ordered();
  overlay_.reset();
  coarse_ = gpu::Framebuffer();
  if (!Window::lost()) window_.give_context();
}

void WindowPictures::draw_when_ordered() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return busy_ || stop_; });
      if (!busy_) break;
    }
    const auto fail = [this](Error why) {  // ends the run, as any failed picture does
      const bool framed = done_.framed;
      done_ = PictureDone();
      done_.framed = framed;
      done_.failed = std::move(why);
    };
    done_ = PictureDone();
    try {
      if (failure_) std::rethrow_exception(failure_);
      if (Window::lost())
        fail(Window::loss());
      else
        draw();
    } catch (const std::exception& error) {
      fail(explain(error));
    } catch (...) {
      fail({"picture", "stopped by an exception of an unknown kind; please report it with the level"});
    }
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
    }
    changed_.notify_all();
    if (!Window::lost()) window_.wake();
  }
}

void WindowPictures::take_snapshots() {
  renderer_.take(world_);
  done_.awake_vertices = 0;
  for (const ObjectSnapshot& object : world_.snapshots->read().objects) done_.awake_vertices += object.awake_vertices;
}

FrameStats WindowPictures::draw_scene(double share) {
  const int width = order_.width, height = order_.height;
  renderer_.pick(order_.question);
  if (share == 1.0) return renderer_.draw(order_.view, 0, width, height);
  const int w = std::max(1, static_cast<int>(width * share)), h = std::max(1, static_cast<int>(height * share));
  if (!coarse_.has_size(w, h)) coarse_ = gpu::Framebuffer(w, h, 0);
  const FrameStats stats = renderer_.draw(order_.view, coarse_.id(), w, h);
  glDisable(GL_FRAMEBUFFER_SRGB);  // copies encoded bytes without conversion
  glBlitNamedFramebuffer(coarse_.id(), 0, 0, 0, w, h, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  return stats;
}

void WindowPictures::draw() {
  renderer_.options() = order_.options;
  take_snapshots();
  if (!order_.frame.empty()) {
    const Image image = renderer_.picture(order_.view, order_.frame_width, order_.frame_height);
    done_.frame = write_file(order_.frame, encode_png(image.width, image.height, image.rgba.data()));
    done_.framed = done_.frame.ok();
  }
  // A picture that is kept may take longer.
  const bool stays = !order_.screenshot.empty();
  done_.stats = draw_scene(stays ? budget_.share_within(kLongestDraw) : budget_.share());
  if (!stays) budget_.drawn(done_.stats.draw_ms);
  done_.answer = renderer_.picked();
  done_.resolution = budget_.share();
  if (order_.shown) {
    overlay_->draw(order_.overlay, renderer_.options(), order_.tint, order_.mouse, order_.width, order_.height,
                   order_.dt);
    done_.wants_mouse = overlay_->wants_mouse();
    done_.orders = overlay_->take_orders();
    done_.panel_orders = overlay_->take_panel_orders();
    done_.widgets = ui::widgets();
    if (stays)
      done_.screenshot = write_file(order_.screenshot, window_png(order_.width, order_.height), Existing::kRefuse);
    window_.present();
  }
  done_.options = renderer_.options();
}

}  // namespace pliant
