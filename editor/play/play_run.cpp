#include "editor/play/play_run.h"

#include "editor/play/play_inside.h"

namespace pliant {

PlayRun::PlayRun(PlayOptions options) : options_(std::move(options)) {
  thread_ = std::thread([this] { run(); });
}

PlayRun::~PlayRun() {
  end();
  if (thread_.joinable()) thread_.join();
}

PlayStatus PlayRun::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void PlayRun::take_samples(std::vector<std::vector<PlaySample>>& out) {
  const std::lock_guard lock(mutex_);
  out.resize(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    out[i].clear();
    out[i].swap(samples_[i]);
  }
}

void PlayRun::post(Command command) {
  const std::lock_guard lock(mutex_);
  commands_.push_back(std::move(command));
  busy_ = true;
  changed_.notify_all();
}

void PlayRun::pause(bool paused) {
  post([paused](Inside& in) {
    if (in.realtime && in.paused != paused) static_cast<void>(in.session->pause(paused));
    in.paused = paused;
    in.due = 0.0;
    if (paused) in.steps = 0;
  });
}

void PlayRun::step(std::uint64_t ticks) {
  post([ticks](Inside& in) {
    if (!in.realtime && !in.again) in.steps += ticks;
  });
}

void PlayRun::set_speed(double speed) {
  post([speed](Inside& in) { in.speed = speed; });
}

void PlayRun::set(const std::string& object, const std::string& key, double value) {
  post([=](Inside& in) {
    if (in.again) return;  // a repeated past is not changed
    if (const Status done = in.session->set(object, key, value); !done) {
      in.say(done.error().message());
      return;
    }
    const std::uint64_t at = in.realtime ? in.parts->clock()->now() + 1 : in.parts->ticks;
    in.past.edits.push_back({at, object, key, value});
  });
}

void PlayRun::set_source(const std::string& effector, const PlaySource& source) {
  post([=](Inside& in) {
    if (in.realtime)
      in.say("what moves a probe can change in lockstep only; it takes effect at the next Play");
    else if (!in.again)
      in.apply(effector, source);
  });
}

void PlayRun::order(const DeviceOrders& orders) {
  post([orders](Inside& in) {
    if (orders.stop_all) in.session->emergency_stop();
    for (const std::string& name : orders.arm) static_cast<void>(in.session->arm(name));
    for (const std::string& name : orders.disarm) static_cast<void>(in.session->disarm(name));
    for (const std::string& name : orders.stop)
      if (SessionEffector* const effector = in.parts->find_effector(name)) effector->link.stop();
  });
}

void PlayRun::go_to(std::uint64_t tick) {
  post([tick](Inside& in) {
    if (in.again)
      in.until = std::min<std::uint64_t>(std::max(tick, in.parts->ticks), in.run.options_.past->ticks.size());
  });
}

void PlayRun::go_on() {
  post([](Inside& in) {
    if (in.again) in.end_past();
    in.paused = false;
    in.due = 0.0;
  });
}

void PlayRun::end() {
  end_ = true;
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

std::shared_ptr<const PlayPast> PlayRun::past() {
  std::shared_ptr<const PlayPast> copy;
  bool done = false;
  post([&](Inside& in) {
    auto made = std::make_shared<const PlayPast>(in.past);
    const std::lock_guard lock(mutex_);
    copy = std::move(made);
    done = true;
    changed_.notify_all();
  });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return done || status_.phase == PlayPhase::kEnded; });
  return copy;
}

void PlayRun::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_ || status_.phase == PlayPhase::kEnded; });
}

bool PlayRun::opened() const {
  const std::lock_guard lock(mutex_);
  return may_picture_ && !end_;
}

World* PlayRun::claim_picture() {
  std::unique_lock lock(mutex_);
  if (!may_picture_ || end_ || has_picture_) return nullptr;
  has_picture_ = true;
  ready_picture_ = parked_ = false;
  changed_.notify_all();
  changed_.wait(lock, [this] { return parked_ || status_.phase == PlayPhase::kEnded; });
  if (status_.phase != PlayPhase::kEnded) return world_;
  has_picture_ = false;
  changed_.notify_all();
  return nullptr;
}

bool PlayRun::pictured() const {
  const std::lock_guard lock(mutex_);
  return ready_picture_;
}

void PlayRun::picture_made() {
  const std::lock_guard lock(mutex_);
  ready_picture_ = true;
  changed_.notify_all();
}

void PlayRun::picture_gone() {
  const std::lock_guard lock(mutex_);
  has_picture_ = false;
  changed_.notify_all();
}

}  // namespace pliant
