#include "systems/touch/feed/feed_field.h"

#include <algorithm>

#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

constexpr std::size_t kEvents = 1 << 14;   // about a thousand ticks of one probe: 1 MiB
constexpr std::size_t kOffsets = 1 << 12;  // zones, over all ticks of a frame: 6 MiB

bool same(const FieldSource& a, const FieldSource& b) {
  return a.center == b.center && a.normal == b.normal && a.amplitude == b.amplitude && a.inv_reach2 == b.inv_reach2 &&
         a.parameter == b.parameter && a.shape == b.shape;
}

}  // namespace

FieldTeller::FieldTeller(std::uint32_t zones, std::size_t sources, bool with_offsets)
    : feed_(std::make_shared<FieldFeed>(kEvents, with_offsets ? kOffsets : 1)),
      told_source_(sources),
      told_mask_(zones, 0),
      told_awake_(zones, 0),
      told_(zones, 0) {
  told_zones_.reserve(zones);
}

void FieldTeller::push(const FieldEvent& event) {
  if (telling_ && !lost_ && !feed_->events.push(event)) lost_ = true;
}

void FieldTeller::fold(std::uint32_t source, const FieldSource& before, const FieldSource& now) {
  push({FieldEvent::kFoldBefore, source, 0, 0, before});
  push({FieldEvent::kFoldNow, source, 0, 0, now});
}

void FieldTeller::source(std::uint32_t source, const FieldSource& now) {
  if (!telling_ || same(told_source_[source], now)) return;
  told_source_[source] = now;
  push({FieldEvent::kSource, source, 0, 0, now});
}

void FieldTeller::zone(std::uint32_t zone, std::uint64_t mask, bool rests, bool sleeps) {
  if (!telling_ || (told_awake_[zone] && told_mask_[zone] == mask && !rests && !sleeps)) return;
  if (!told_[zone]) {
    told_[zone] = 1;
    told_zones_.push_back(zone);  // capacity: all
  }
  told_awake_[zone] = !sleeps;
  told_mask_[zone] = mask;
  push({FieldEvent::kZone, zone, mask, (rests ? FieldEvent::kRests : 0) | (sleeps ? FieldEvent::kSleeps : 0), {}});
}

void FieldTeller::offsets(std::uint32_t source, std::uint32_t zone, const std::vector<vec3>& offset, bool fold) {
  if (!telling_ || lost_) return;
  lost_ = !feed_->events.has_room();  // a block is sent with its event or not at all
  if (lost_) return;
  FieldOffsets block;
  std::copy_n(offset.begin() + static_cast<std::ptrdiff_t>(zone * kZoneSize), kZoneSize, block.offset.begin());
  lost_ = !feed_->offsets.push(block);
  if (lost_) return;
  push({fold ? FieldEvent::kFoldOffsets : FieldEvent::kOffsets, zone, source, 0, {}});
}

void FieldTeller::end_tick(std::uint64_t tick) {
  push({FieldEvent::kTick, 0, tick, 0, {}});
}

void FieldTeller::give_up_if_lost(ObjectState& object, HeightField& field) {
  if (!feed_) return;
  if (feed_->wants_reset.load(std::memory_order_relaxed)) lost_ = true;
  if (!telling_ || !lost_) return;
  telling_ = false;
  const auto mark = [&](std::uint32_t zone) {
    if (field.zone_state[zone] & kZoneDirty) return;
    field.zone_state[zone] |= kZoneDirty;
    object.dirty.push_back(zone);  // capacity: all zones
  };
  for (const std::uint32_t zone : told_zones_) mark(zone);
  for (const std::uint32_t zone : field.awake) mark(zone);
}

void FieldTeller::begin_if_at_rest(const ObjectState& object, const HeightField& field) {
  if (!feed_ || telling_) return;
  if (!field.awake.empty() || !object.dirty.empty() || !object.waiting.empty()) return;
  feed_->wants_reset.store(false, std::memory_order_relaxed);
  for (const std::uint32_t zone : told_zones_) told_[zone] = told_awake_[zone] = 0;
  told_zones_.clear();
  std::fill(told_source_.begin(), told_source_.end(), FieldSource{});
  lost_ = false;
  telling_ = true;
  push({FieldEvent::kReset, 0, 0, 0, {}});
  telling_ = !lost_;
}

}  // namespace pliant
