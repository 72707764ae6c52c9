// The touch clock's end of a FieldFeed (components/field_feed.h). Where the reader falls behind a whole ring, or comes
// late, the field's zones travel as streams again (publish) until the surface has come to rest: nothing is lost.
#pragma once

#include <memory>
#include <vector>

#include "components/field_feed.h"
#include "components/height_field.h"

namespace pliant {

struct ObjectState;

class FieldTeller {
 public:
  FieldTeller() = default;
  FieldTeller(std::uint32_t zones, std::size_t sources, bool with_offsets);

  const std::shared_ptr<FieldFeed>& feed() const { return feed_; }
  // The feed is what the reader draws from; else zones have to travel.
  bool tells() const { return telling_; }

  void fold(std::uint32_t source, const FieldSource& before, const FieldSource& now);
  void source(std::uint32_t source, const FieldSource& now);
  void zone(std::uint32_t zone, std::uint64_t mask, bool rests, bool sleeps);
  // Of a zone's vertices, beginning at the mesh's vertex zone * kZoneSize.
  void offsets(std::uint32_t source, std::uint32_t zone, const std::vector<vec3>& offset, bool fold);
  void end_tick(std::uint64_t tick);

  // At most once a tick, and before its first event: a reader that has come late, or fell behind, needs the streams of
  // all zones that were told of; they are marked dirty.
  void give_up_if_lost(ObjectState& object, HeightField& field);
  // Begins, if the surface is at rest and the reader knows it.
  void begin_if_at_rest(const ObjectState& object, const HeightField& field);

 private:
  void push(const FieldEvent& event);

  std::shared_ptr<FieldFeed> feed_;
  bool telling_ = false, lost_ = false;
  std::vector<FieldSource> told_source_;
  std::vector<std::uint64_t> told_mask_;   // per zone
  std::vector<std::uint8_t> told_awake_;   // per zone
  std::vector<std::uint8_t> told_;         // per zone: the reader's copy may be other than rest
  std::vector<std::uint32_t> told_zones_;  // those; capacity: all
};

}  // namespace pliant
