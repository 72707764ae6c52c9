// The window of a session (pliant.view).
#include <utility>

#include "python/src/held_session.h"
#include "python/src/sessions.h"

namespace pliant_python {
namespace {

using Moment = std::chrono::steady_clock;

constexpr auto kFrame = std::chrono::milliseconds(16);  // at least between pictures
std::atomic<bool> g_window{false};                      // GLFW has one in a process

}  // namespace

void SessionWindow::end() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

pliant::Error SessionWindow::why() {
  const std::lock_guard lock(mutex_);
  return why_;
}

void SessionWindow::draw() {
  if (!window_) return;
  const auto begin = Moment::now();
  const double dt = std::chrono::duration<double>(begin - std::exchange(drawn_, begin)).count();
  held_.ensure_pictures();
  held_.worker_->run([&] { check(held_.pictures_->draw(window_->view(dt), 0, window_->width(), window_->height())); });
  cost_ = Moment::now() - begin;
  ++pictures_;
}

void SessionWindow::show_in_long_call() {
  if (!window_ || Moment::now() - drawn_ < 5 * cost_) return;
  try {
    draw();
    held_.worker_->run([&] {
      window_->present();
      if (!window_->poll()) ends_ = true;
    });
  } catch (const Failure&) {  // its own thread meets the same, and says it
  }
}

void SessionWindow::let_go() {
  if (!window_) return;
  held_.worker_->run([&] {
    held_.pictures_.reset();
    window_.reset();
  });
  open_ = false;
  g_window = false;
}

// Input and presenting need no lock of the session: vertical sync may take 16 ms.
void SessionWindow::run() {
  Worker& worker = *held_.worker_;
  try {
    while (!ends_) {
      const auto begin = Moment::now();
      pliant::Error lost;
      if (worker.run([&] { return window_->lost(lost); })) throw Failure(std::move(lost));
      if (!worker.run([&] { return window_->poll(); })) break;
      {
        const HeldSession::Lock lock(held_);
        draw();
      }
      worker.run([&] { window_->present(); });
      const auto took = Moment::now() - begin;  // where pictures are slow, callers have as much time between them
      std::this_thread::sleep_for(took > kFrame ? took : kFrame - took);
    }
  } catch (const Failure& failure) {
    const std::lock_guard lock(mutex_);
    why_ = failure.error;
  }
  const std::lock_guard lock(held_.mutex_);
  let_go();
}

void HeldSession::open_window(OpenViewWindow open, int width, int height, const std::string& title) {
  may_call();
  const py::gil_scoped_release without_gil;
  const std::lock_guard window_lock(window_mutex_);
  if (window_ && !window_->open()) window_->end();
  const Lock lock(*this);
  if (window_ && !window_->open()) window_.reset();
  if (g_window.exchange(true))
    throw Failure(pliant::Error{"view", "a window is open already", "close that one first", "call.refused"});
  try {
    if (session_->running())
      throw Failure(pliant::Error{"view", "the clocks are running", "open it before start()", "call.refused"});
    if (!worker_) worker_ = std::make_unique<Worker>();
    worker_->run([&] {
      pictures_.reset();
      pliant::Error why;
      auto shown = open(width, height, why);
      if (!shown) throw Failure(why);
      pictures_.emplace(check(pliant::Pictures::in_current_context(*session_)));
      pictures_stale_ = false;
      const auto bounds = session_->bounds();  // an error of a scene without objects
      shown->show(pictures_->view(), bounds ? *bounds : pliant::Bounds{}, title);
      window_ = std::make_unique<SessionWindow>(*this, std::move(shown));
    });
  } catch (...) {
    g_window = false;
    throw;
  }
  window_->begin();
}

void HeldSession::close_window() {
  const py::gil_scoped_release without_gil;
  const std::lock_guard window_lock(window_mutex_);
  if (window_ && !is_of_parent()) window_->end();  // it lets go of all but its count
}

HeldSession::Shown HeldSession::window() {
  const py::gil_scoped_release without_gil;
  const std::lock_guard window_lock(window_mutex_);
  if (!window_) return {};
  if (const pliant::Error why = window_->why(); !why.what.empty() && why.code != "session.closed") throw Failure(why);
  return {window_->open(), window_->pictures()};
}

void bind_window(SessionClass& session) {
  session
      .def("_open_window",
           [](HeldSession& held, const py::capsule& open, int width, int height, const std::string& title) {
             if (width < 1 || height < 1 || width > 16384 || height > 16384)
               wrong_argument("view", "its width and height must be from 1 to 16384 pixels", "");
             held.open_window(reinterpret_cast<OpenViewWindow>(open.get_pointer()), width, height, title);
           })
      .def("_close_window", &HeldSession::close_window)
      .def("_window", [](HeldSession& held) {
        const HeldSession::Shown shown = held.window();
        return py::make_tuple(shown.open, shown.pictures);
      });
}

}  // namespace pliant_python
