#include "editor/play/play_run.h"

#include "editor/play/play_inside.h"

namespace pliant {

PlayRun::PlayRun(PlayOptions options) : options_(std::move(options)), inside_(std::make_unique<Inside>(*this)) {
  thread_ = std::thread([this] { run(); });
}

PlayRun::~PlayRun() {
  end();
  if (thread_.joinable()) thread_.join();
}

const PlayStatus& PlayRun::status() {
  reported_.acquire();
  return reported_.read();
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
    if (const Status done = in.session->set(object, key, value); !done) in.say(done.error().message());
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
      if (SessionEffector* const effector = in.inner->find_effector(name)) effector->link.stop();
  });
}

void PlayRun::go_to(std::uint64_t tick) {
  post([tick](Inside& in) {
    if (in.again)
      in.until = std::min<std::uint64_t>(std::max(tick, in.inner->ticks), in.run.options_.past->ticks.size());
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
    auto made = std::make_shared<const PlayPast>(in.past());
    const std::lock_guard lock(mutex_);
    copy = std::move(made);
    done = true;
    changed_.notify_all();
  });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return done || ended_; });
  return copy;
}

void PlayRun::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_ || ended_; });
}

bool PlayRun::make_picture(const std::function<void(World&)>& make) {
  const std::lock_guard still(stands_still_);
  if (!opened() || inside_->inner->clock()) return false;
  make(inside_->inner->world);
  const std::lock_guard lock(mutex_);
  pictured_ = true;
  changed_.notify_all();
  return true;
}

}  // namespace pliant
