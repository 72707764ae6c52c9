#include "editor/play/play_hand.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// A picture may be late, and its point far from the last one. A jump would be treated as a device fault
// (systems/safety/safety.h), with zero force; so the speed is limited.
constexpr double kGlideTime = 0.015;   // [s] time constant towards the target
constexpr double kFastestFree = 8.0;   // [m/s] away from every surface
constexpr double kFastestSlide = 0.5;  // [m/s] in contact
constexpr double kSwingArc = 0.6;      // [1] of the remaining distance: height of the arc over obstacles

}  // namespace

void PlayHand::take_probe(const World& world, const Probe& probe, const Viewpoint& view, std::optional<dvec3> from) {
  const std::lock_guard lock(mutex_);
  hand_.take(Pointer(world, probe.radius, view, probe.meets));
  watched_ = kNoEntity;
  takes_ = false;
  at_ = from ? *from : *hand_.update(0.0);
}

void PlayHand::take_tool(const World& world, Entity tool, dvec3 device) {
  const std::lock_guard lock(mutex_);
  hand_.take(Carrier::holding(world, tool, device));
  if (takes_) hand_.press(false, device);
  watched_ = kNoEntity;
  takes_ = false;
}

void PlayHand::watch_tool(Entity tool) {
  const std::lock_guard lock(mutex_);
  hand_.let_go();
  watched_ = tool;
  takes_ = false;
}

bool PlayHand::takes() const {
  const std::lock_guard lock(mutex_);
  return takes_;
}

void PlayHand::let_go() {
  const std::lock_guard lock(mutex_);
  hand_.let_go();
  watched_ = kNoEntity;
  takes_ = false;
}

std::optional<dvec3> PlayHand::update(double dt) {
  const std::lock_guard lock(mutex_);
  const std::optional<dvec3> to = hand_.update(dt);
  if (!to || !hand_.has_probe()) return to;
  const bool free = hand_.free();
  dvec3 way = *to - at_;
  if (free && hand_.seen()) way += kSwingArc * length(way) * hand_.seen()->normal;
  const double left = length(way), most = (free ? kFastestFree : kFastestSlide) * dt;
  at_ += way * std::min(1.0 - std::exp(-dt / kGlideTime), left > most ? most / left : 1.0);
  return at_;
}

PlayHand::Over PlayHand::over() const {
  const std::lock_guard lock(mutex_);
  if (watched_ == kNoEntity) return hand_.over();
  return hand_.seen() && hand_.seen()->object == watched_ ? Over::kTool : Over::kNothing;
}

bool PlayHand::hold(bool held, bool pulls) {
  const std::lock_guard lock(mutex_);
  takes_ = held && !(watched_ == kNoEntity) && hand_.seen() && hand_.seen()->object == watched_;
  if (!held) hand_.release();
  return takes_ || (held && hand_.press(pulls, dvec3(0)) != MouseHand::Grip::kNone);
}

}  // namespace pliant
