#include "editor/core/live_stroke.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr double kSlice = 12.0;  // [ms] of dabs between two checks for new input

}  // namespace

LiveStroke::LiveStroke(std::shared_ptr<const PaintSurface> surface, std::vector<PaintLayer> layers,
                       PaintAttribute attribute, const Brush& brush, std::function<void()> wake)
    : surface_(std::move(surface)), wake_(std::move(wake)) {
  thread_ = std::thread(
      [this, layers = std::move(layers), attribute, brush]() mutable { run(std::move(layers), attribute, brush); });
}

LiveStroke::~LiveStroke() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveStroke::move(const Ray& ray, double pressure) {
  const std::lock_guard lock(mutex_);
  pointers_.push_back({ray, pressure});
  changed_.notify_all();
}

void LiveStroke::finish() {
  const std::lock_guard lock(mutex_);
  finish_ = true;
  changed_.notify_all();
}

bool LiveStroke::finished() const {
  const std::lock_guard lock(mutex_);
  return finished_;
}

bool LiveStroke::idle() const {
  const std::lock_guard lock(mutex_);
  return pointers_.empty() && !working_ && made_.layers.empty() && finish_ == finished_;
}

LiveStroke::Made LiveStroke::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, {});
}

void LiveStroke::run(std::vector<PaintLayer> layers, PaintAttribute attribute, Brush brush) {
  Stroke stroke(*surface_, paint_of(layers, *surface_, attribute), brush);
  MeshPaint now = stroke.before();
  for (;;) {
    std::optional<Pointer> to;
    {
      std::unique_lock lock(mutex_);
      working_ = stroke.waits();
      changed_.wait(lock, [&] { return stop_ || finish_ || !pointers_.empty() || stroke.waits(); });
      if (stop_) return;
      if (!pointers_.empty()) {
        to = pointers_.front();
        pointers_.pop_front();
      } else if (!stroke.waits()) {
        finished_ = true;
        break;
      }
      working_ = true;
    }
    const PaintChanges changes = to ? stroke.move(to->ray, to->pressure, kSlice) : stroke.go_on(kSlice);
    now = with(now, changes);
    const std::lock_guard lock(mutex_);
    made_.at = stroke.last_dab();
    for (const PaintedRange& range : changes.ranges) {
      const auto same =
          std::find_if(made_.layers.begin(), made_.layers.end(), [&](auto& l) { return l.first == range.primitive; });
      if (same == made_.layers.end())
        made_.layers.emplace_back(range.primitive, now.layers[range.primitive]);
      else
        same->second = now.layers[range.primitive];
    }
    if (!changes.ranges.empty() && wake_) wake_();
  }
  if (wake_) wake_();
}

}  // namespace pliant
