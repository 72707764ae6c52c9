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

FeedWriter::FeedWriter(std::uint32_t zones, std::size_t sources, bool with_offsets)
    : feed_(std::make_shared<FieldFeed>(kEvents, with_offsets ? kOffsets : 1)),
      reported_source_(sources),
      reported_mask_(zones, 0),
      reported_awake_(zones, 0),
      reported_(zones, 0) {
  reported_zones_.reserve(zones);
}

void FeedWriter::push(const FieldEvent& event) {
  if (feeds_ && !lost_ && !feed_->events.push(event)) lost_ = true;
}

void FeedWriter::fold(std::uint32_t source, const FieldSource& before, const FieldSource& now) {
  push({FieldEvent::kFoldBefore, source, 0, 0, before});
  push({FieldEvent::kFoldNow, source, 0, 0, now});
}

void FeedWriter::source(std::uint32_t source, const FieldSource& now) {
  if (!feeds_ || same(reported_source_[source], now)) return;
  reported_source_[source] = now;
  push({FieldEvent::kSource, source, 0, 0, now});
}

void FeedWriter::zone(std::uint32_t zone, std::uint64_t mask, bool rests, bool sleeps) {
  if (!feeds_ || (reported_awake_[zone] && reported_mask_[zone] == mask && !rests && !sleeps)) return;
  if (!reported_[zone]) {
    reported_[zone] = 1;
    reported_zones_.push_back(zone);  // capacity: all
  }
  reported_awake_[zone] = !sleeps;
  reported_mask_[zone] = mask;
  push({FieldEvent::kZone, zone, mask, (rests ? FieldEvent::kRests : 0) | (sleeps ? FieldEvent::kSleeps : 0), {}});
}

void FeedWriter::offsets(std::uint32_t source, std::uint32_t zone, const Offsets& offset, bool fold) {
  if (!feeds_ || lost_) return;
  lost_ = !feed_->events.has_room();  // a block is sent with its event or not at all
  if (lost_) return;
  FieldOffsets block;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) block.offset[i] = offset[zone * kZoneSize + i];
  lost_ = !feed_->offsets.push(block);
  if (lost_) return;
  push({fold ? FieldEvent::kFoldOffsets : FieldEvent::kOffsets, zone, source, 0, {}});
}

void FeedWriter::end_tick(std::uint64_t tick) {
  push({FieldEvent::kTick, 0, tick, 0, {}});
}

void FeedWriter::give_up_if_lost(ObjectState& object, HeightField& field) {
  if (!feed_) return;
  if (feed_->wants_reset.load(std::memory_order_relaxed)) lost_ = true;
  if (!feeds_ || !lost_) return;
  feeds_ = false;
  const auto mark = [&](std::uint32_t zone) {
    if (field.zone_state[zone] & kZoneDirty) return;
    field.zone_state[zone] |= kZoneDirty;
    object.dirty.push_back(zone);  // capacity: all zones
  };
  for (const std::uint32_t zone : reported_zones_) mark(zone);
  for (const std::uint32_t zone : field.awake) mark(zone);
}

void FeedWriter::begin_if_at_rest(const ObjectState& object, const HeightField& field) {
  if (!feed_ || feeds_) return;
  if (!field.awake.empty() || !object.dirty.empty() || !object.waiting.empty()) return;
  feed_->wants_reset.store(false, std::memory_order_relaxed);
  for (const std::uint32_t zone : reported_zones_) reported_[zone] = reported_awake_[zone] = 0;
  reported_zones_.clear();
  std::fill(reported_source_.begin(), reported_source_.end(), FieldSource{});
  lost_ = false;
  feeds_ = true;
  push({FieldEvent::kReset, 0, 0, 0, {}});
  feeds_ = !lost_;
}

}  // namespace pliant
