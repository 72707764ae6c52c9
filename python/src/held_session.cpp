#include "python/src/held_session.h"

#include <pthread.h>

#include <cstring>
#include <vector>

namespace pliant_python {
namespace {

std::atomic<unsigned> g_process{0};  // number of forks behind this process
const int g_counts_forks = pthread_atfork(nullptr, nullptr, [] { ++g_process; });

std::atomic<std::thread::id> g_ending;  // the thread that ends the program; valid once g_ends
std::atomic<bool> g_ends{false};

std::mutex g_mutex;  // guards the list
std::vector<std::weak_ptr<HeldSession>>& all_sessions() {
  static auto* const sessions = new std::vector<std::weak_ptr<HeldSession>>;  // sessions may end after statics
  return *sessions;
}

}  // namespace

WithoutGil::~WithoutGil() {
  while (g_ends && std::this_thread::get_id() != g_ending.load()) std::this_thread::sleep_for(std::chrono::hours(1));
  PyEval_RestoreThread(state_);
}

void check_end() {
  if (g_ends) throw Failure(pliant::Error{"Session", "is closed: the program ends", "", "session.closed"});
}

bool interrupted() {
  const py::gil_scoped_acquire gil;
  return PyErr_CheckSignals() != 0;
}

HeldSession::HeldSession() : process_(g_process) {
  (void)g_counts_forks;
}

std::shared_ptr<HeldSession> HeldSession::open(const pliant::Scene& scene) {
  auto held = std::make_shared<HeldSession>();
  bool stopped = false;
  {
    const WithoutGil without_gil;
    auto opened = pliant::Session::open(scene, [&](double, const std::string&) {
      stopped = stopped || interrupted();
      return !stopped;
    });
    if (!opened && !stopped) throw Failure(opened.error());
    if (opened && !stopped) {
      held->session_ = std::make_unique<pliant::Session>(std::move(opened).value());
      held->read_names();
    }
  }
  if (stopped) throw py::error_already_set();
  check_laws();
  const std::lock_guard lock(g_mutex);
  std::erase_if(all_sessions(), [](const auto& each) { return each.expired(); });
  all_sessions().push_back(held);
  return held;
}

HeldSession::~HeldSession() {
  if (is_of_parent()) {  // its threads are not in this process
    (void)window_.release();
    (void)session_.release();
    (void)worker_.release();
    if (pictures_) (void)new pliant::Pictures(std::move(*pictures_));
    return;
  }
  if (session_) close();
}

void HeldSession::read_names() {
  effectors_ = session_->effectors();
  objects_ = session_->objects();
  for (const auto* names : {&effectors_, &objects_})
    for (const std::string& name : *names)
      if (auto keys = session_->keys(name)) kinds_[name] = keys->kind;
}

HeldSession::Lock::Lock(HeldSession& of) : held(of) {
  held.mutex_.lock();
  held.owner_ = std::this_thread::get_id();
  if (!held.closed_) return;
  held.owner_ = std::thread::id();
  held.mutex_.unlock();
  throw Failure(pliant::Error{"Session", "is closed", "open another one", "session.closed"});
}

HeldSession::Lock::~Lock() {
  held.owner_ = std::thread::id();
  held.mutex_.unlock();
}

bool HeldSession::is_of_parent() const {
  return process_ != g_process;
}

void HeldSession::may_call() const {
  if (closed_) throw Failure(pliant::Error{"Session", "is closed", "open another one", "session.closed"});
  if (is_of_parent())
    throw Failure(pliant::Error{"Session", "was opened before fork(), in another process",
                                "open it in the process that uses it", "session.forked"});
  if (owner_ == std::this_thread::get_id())
    throw Failure(pliant::Error{"Session", "is called from its own driver", "let the driver use its own arguments",
                                "session.reentrant"});
}

void HeldSession::close() {
  if (is_of_parent() || owner_ == std::this_thread::get_id()) may_call();
  const WithoutGil without_gil;
  const std::lock_guard window_lock(window_mutex_);
  if (window_) window_->end();
  const std::lock_guard lock(mutex_);
  if (closed_.exchange(true)) return;
  if (worker_) worker_->run([&] { pictures_.reset(); });
  worker_.reset();
  session_.reset();
}

bool HeldSession::is_tool(const std::string& effector) const {
  const auto found = kinds_.find(effector);
  return found != kinds_.end() && found->second == pliant::NamedKind::kTool;
}

const std::string& HeldSession::only_effector(const char* call) const {
  if (effectors_.size() == 1) return effectors_.front();
  std::string names;
  for (const std::string& name : effectors_) names += (names.empty() ? "" : ", ") + name;
  if (effectors_.empty())
    throw Failure(
        pliant::Error{call, "the scene has no probe and no tool", "add one: Scene.add_probe", "name.unknown"});
  wrong_argument(call, "the scene has several probes and tools: " + names,
                 "give each its pose by name: {'" + effectors_.front() + "': ...}");
}

void HeldSession::refresh() {
  if (window_ && window_->open() && pictures_stale_) {  // before the clocks can start again
    try {
      ensure_pictures();
    } catch (const Failure&) {  // the next picture fails likewise, and ends the window with that
    }
  }
  if (views_.empty() || session_->running()) return;
  for (auto each = views_.begin(); each != views_.end();) {
    const std::shared_ptr<Vertices> view = each->second.lock();
    if (!view) {
      each = views_.erase(each);
      continue;
    }
    const pliant::Status seen = on_picture_thread([&] { return session_->vertices(each->first, scratch_); });
    if (seen && scratch_.size() == view->at.size())
      std::memcpy(view->at.data(), scratch_.data(), scratch_.size() * sizeof(pliant::vec3));
    ++each;
  }
}

py::array HeldSession::vertices(const std::string& object) {
  auto view = look([&](pliant::Session& session) {
    check(session.vertices(object, scratch_));
    std::shared_ptr<Vertices> found = views_[object].lock();
    if (!found || found->at.size() != scratch_.size()) {
      found = std::make_shared<Vertices>();
      found->at.resize(scratch_.size());
      views_[object] = found;
    }
    std::memcpy(found->at.data(), scratch_.data(), scratch_.size() * sizeof(pliant::vec3));
    return found;
  });
  auto* const owner = new std::shared_ptr<Vertices>(view);
  const py::capsule base(owner, [](void* p) { delete static_cast<std::shared_ptr<Vertices>*>(p); });
  py::array array(py::dtype::of<float>(), {static_cast<py::ssize_t>(view->at.size()), py::ssize_t{3}},
                  reinterpret_cast<const float*>(view->at.data()), base);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

void HeldSession::ensure_pictures() {
  if (!worker_) worker_ = std::make_unique<Worker>();
  worker_->run([&] {
    if (std::exchange(pictures_stale_, false)) pictures_.reset();
    if (!pictures_)
      pictures_.emplace(check(window_ && window_->open() ? pliant::Pictures::in_current_context(*session_)
                                                         : pliant::Pictures::headless(*session_)));
  });
}

pliant::Picture HeldSession::picture(const std::optional<pliant::PictureView>& view, int width, int height) {
  may_call();
  const WithoutGil without_gil;
  const Lock lock(*this);
  ensure_pictures();
  return worker_->run([&] { return check(pictures_->picture(view ? *view : pictures_->view(), width, height)); });
}

pliant::PictureView HeldSession::view() {
  may_call();
  const WithoutGil without_gil;
  const Lock lock(*this);
  ensure_pictures();
  return worker_->run([&] { return pictures_->view(); });
}

void close_all_sessions() {
  g_ending = std::this_thread::get_id();
  g_ends = true;
  std::vector<std::shared_ptr<HeldSession>> open;
  {
    const std::lock_guard lock(g_mutex);
    for (const auto& each : all_sessions())
      if (auto session = each.lock()) open.push_back(std::move(session));
  }
  for (const auto& each : open) {
    try {
      each->close();
    } catch (const Failure&) {  // a session of the parent process
    }
  }
}

}  // namespace pliant_python
