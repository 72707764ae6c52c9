// The touch clock's end of a FieldFeed (components/field_feed.h). If the reader falls behind by a whole ring, or joins
// late, the field's zones are published as streams again until the surface has come to rest: nothing is lost.
#pragma once

#include <memory>
#include <vector>

#include "components/field_feed.h"
#include "components/height_field.h"

namespace pliant {

struct ObjectState;
struct Offsets;

class FeedWriter {
 public:
  FeedWriter() = default;
  FeedWriter(std::uint32_t zones, std::size_t sources, bool with_offsets);

  const std::shared_ptr<FieldFeed>& feed() const { return feed_; }
  // The reader draws from the feed; else zones must be published.
  bool feeds() const { return feeds_; }

  void fold(std::uint32_t source, const FieldSource& before, const FieldSource& now);
  void source(std::uint32_t source, const FieldSource& now);
  void zone(std::uint32_t zone, std::uint64_t mask, bool rests, bool sleeps);
  // Of a zone's vertices; `offset` is indexed by the mesh's vertices, from zone * kZoneSize on.
  void offsets(std::uint32_t source, std::uint32_t zone, const Offsets& offset, bool fold);
  void end_tick(std::uint64_t tick);

  // At most once a tick, before its first event. A reader that joined late or fell behind needs the streams of all
  // zones sent so far: they are marked dirty.
  void give_up_if_lost(ObjectState& object, HeightField& field);
  // Begins if the surface is at rest and the reader knows it.
  void begin_if_at_rest(const ObjectState& object, const HeightField& field);

 private:
  void push(const FieldEvent& event);

  std::shared_ptr<FieldFeed> feed_;
  bool feeds_ = false, lost_ = false;
  std::vector<FieldSource> reported_source_;
  std::vector<std::uint64_t> reported_mask_;   // per zone
  std::vector<std::uint8_t> reported_awake_;   // per zone
  std::vector<std::uint8_t> reported_;         // per zone: the reader's copy may differ from rest
  std::vector<std::uint32_t> reported_zones_;  // those; capacity: all
};

}  // namespace pliant
