// A Session that any Python thread may call: one lock a session, calls without the GIL, live views of vertices, and
// pictures on a thread of their own.
//
// A call checks in this order: closed, opened in another process (fork), called from inside itself (a Python driver).
// The lock is only waited for without the GIL; callbacks take the GIL while the lock is held, never the other way.
#pragma once

#include <pliant/picture.h>
#include <pliant/session.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "python/src/failure.h"
#include "python/src/laws.h"
#include "python/src/view_window.h"
#include "python/src/worker.h"

namespace pliant_python {

// Releases the GIL for its lifetime. Once the program ends, a thread of its own stays in the destructor until the
// process is gone: there Python would end it by unwinding, which a destructor must not let through.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;
  ~WithoutGil();

 private:
  PyThreadState* state_;
};

// The vertices of one object, float32; arrays in Python point into it, so it is never resized.
struct Vertices {
  std::vector<pliant::vec3> at;
};

class HeldSession;

// A window on a session. Its thread takes the session's lock for each picture; the clocks of real time never take that
// lock. The OpenGL context is on the session's picture thread.
class SessionWindow {
 public:
  SessionWindow(HeldSession& held, std::unique_ptr<ViewWindow> window) : held_(held), window_(std::move(window)) {}
  ~SessionWindow() { end(); }
  void begin() {
    thread_ = std::thread([this] { run(); });
  }
  void end();                // waits for its thread, which may wait for the session's lock
  void show_in_long_call();  // with the session's lock, which its thread waits for: a picture of the state now
  bool open() const { return open_; }
  std::uint64_t pictures() const { return pictures_; }
  pliant::Error why();  // its code is not empty: what ended it

 private:
  void run();
  void draw();    // with the session's lock
  void let_go();  // with the session's lock: closes the window
  HeldSession& held_;
  std::unique_ptr<ViewWindow> window_;
  std::atomic<bool> open_{true}, ends_{false};
  std::atomic<std::uint64_t> pictures_{0};
  std::chrono::steady_clock::time_point drawn_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration cost_{0};  // of the last picture; long calls spend a fifth of their time on them
  std::mutex mutex_;                             // protects why_
  pliant::Error why_;
  std::thread thread_;
};

class HeldSession {
 public:
  // Opens it without the GIL; Ctrl-C ends the opening.
  static std::shared_ptr<HeldSession> open(const pliant::Scene& scene);
  HeldSession();
  // pybind11 allocates what `Session.__new__` left without __init__ by this.
  static void* operator new(std::size_t) { not_initialised("Session"); }
  static void operator delete(void*) {}
  HeldSession(const HeldSession&) = delete;
  HeldSession& operator=(const HeldSession&) = delete;
  ~HeldSession();

  void close();  // stops the clocks; later calls are errors; views keep their last values
  bool closed() const { return closed_; }

  // call(session), without the GIL, under the lock. Python objects must not be touched in it.
  template <class Call>
  auto with(Call&& call) {
    may_call();
    const WithoutGil without_gil;
    const Lock lock(*this);
    return call(*session_);
  }
  // The same for calls that look at the newest state: while there are pictures, on the thread of their GL context.
  template <class Call>
  auto look(Call&& call) {
    may_call();
    const WithoutGil without_gil;
    const Lock lock(*this);
    return on_picture_thread([&] { return call(*session_); });
  }
  // The same for calls that run ticks or change the state: refreshes the live views after it, also when it throws.
  template <class Call>
  auto advance(Call&& call) {
    may_call();
    const WithoutGil without_gil;
    const Lock lock(*this);
    struct Refresh {
      HeldSession& of;
      ~Refresh() { of.refresh(); }
    } refresh_after{*this};
    try {
      if constexpr (std::is_void_v<std::invoke_result_t<Call, pliant::Session&>>) {
        call(*session_);
        check_laws();
      } else {
        auto result = call(*session_);
        check_laws();
        return result;
      }
    } catch (Failure& failure) {
      failure.caused_by(raised_);
      throw;
    }
  }
  // In `advance`: pictures belong to one run, and a new one has begun.
  void forget_pictures() { pictures_stale_ = true; }

  py::array vertices(const std::string& object);  // read-only, live
  pliant::Picture picture(const std::optional<pliant::PictureView>& view, int width, int height);
  pliant::PictureView view();

  // A window, drawn beside the session until close_window() or its user closes it. One in a process.
  void open_window(OpenViewWindow open, int width, int height, const std::string& title);
  void close_window();
  struct Shown {
    bool open = false;
    std::uint64_t pictures = 0;
  };
  Shown window();             // throws what ended it, if that was a failure
  void show_in_long_call() {  // with the lock
    if (window_) window_->show_in_long_call();
  }

  const std::vector<std::string>& effectors() const { return effectors_; }
  bool is_tool(const std::string& effector) const;
  const std::string& only_effector(const char* call) const;
  const std::vector<std::string>& objects() const { return objects_; }
  pliant::NamedKind kind(const std::string& name) const { return kinds_.at(name); }
  bool probe_added = false;
  const std::shared_ptr<Raised>& raised() const { return raised_; }

 private:
  friend class SessionWindow;
  struct Lock {
    explicit Lock(HeldSession& of);
    ~Lock();
    HeldSession& held;
  };
  bool is_of_parent() const;  // opened before a fork()
  void may_call() const;
  void refresh();
  void read_names();
  template <class Call>
  auto on_picture_thread(Call&& call) {
    return worker_ ? worker_->run(std::forward<Call>(call)) : call();
  }
  void ensure_pictures();

  std::mutex mutex_;
  std::atomic<std::thread::id> owner_{};
  std::atomic<bool> closed_{false};
  unsigned process_;  // counts forks
  std::unique_ptr<pliant::Session> session_;
  std::vector<std::string> effectors_, objects_;
  std::map<std::string, pliant::NamedKind> kinds_;
  std::map<std::string, std::weak_ptr<Vertices>> views_;
  std::vector<pliant::vec3> scratch_;
  std::shared_ptr<Raised> raised_ = std::make_shared<Raised>();
  std::unique_ptr<Worker> worker_;
  std::optional<pliant::Pictures> pictures_;
  std::mutex window_mutex_;  // taken before mutex_: one thread opens or closes
  std::unique_ptr<SessionWindow> window_;
  bool pictures_stale_ = false;
};

// Closes every session: clocks and Python drivers end before the interpreter does.
void close_all_sessions();
// Throws once the program ends, so that a call on a thread of its own does not keep it.
void check_end();
// True if a signal handler raised: Ctrl-C. With the GIL taken for the moment; its exception is then set.
bool interrupted();

}  // namespace pliant_python
