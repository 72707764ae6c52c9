// A field without a closed form, stepped on the GPU. The shader replay.comp performs the steps of the CPU kernels
// (field_kernels.h), tick by tick, from the inputs that the touch clock streams (components/field_feed.h). The ticks of
// a frame are one dispatch, with one work group for each zone that was awake in any of them. The state stays on the
// GPU.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "components/field_feed.h"
#include "components/world.h"
#include "systems/touch/model/painted_motion.h"
#include "systems/visual/field_gpu.h"

namespace pliant {

class ReplayProgram {
 public:
  static Result<ReplayProgram> make();

 private:
  friend class FieldReplay;
  gpu::Program program_;
};

// One object's field.
class FieldReplay {
 public:
  FieldReplay() = default;
  FieldReplay(const Mesh& mesh, const Deformable& deformable, double dt);

  // Takes the inputs up to tick number `tick`. False while the newest field is in the snapshot's zones.
  bool take(FieldFeed& feed, bool fed, std::uint64_t tick);
  // Performs these steps and writes the last stream of each zone. Returns the bytes uploaded.
  std::size_t evaluate(const ReplayProgram& program, const gpu::Buffer& stream);
  bool at_rest() const { return awake_.empty() && runs_.empty(); }
  std::size_t bytes() const { return state_.size(); }  // that a shader must address

 private:
  // The shader's input, as its records of uvec4. One tick:
  struct Row {
    std::uint64_t used = 0, folded = 0;  // known sources; ended sources
    std::uint32_t first_source = 0, first_fold = 0, pad[2] = {};
  };
  // Ticks [first, first + count) in which a zone's inputs did not change. `before`: the sources of the previous tick,
  // which folds refer to. Offsets: indices of blocks, one per source of `mask`, one per folded source of `before`.
  struct Run {
    std::uint32_t first = 0, count = 0, zone = 0, flags = 0;
    std::uint64_t mask = 0, before = 0;
    std::uint32_t offsets = 0, fold_offsets = 0, pad[2] = {};
  };
  static constexpr std::uint32_t kNone = ~0u;
  struct Zone {
    std::uint64_t mask = 0, next = 0;  // in the last tick, and from this one on
    std::uint32_t run = kNone;         // the current one
    std::uint32_t flags = 0;           // of this tick
    bool awake = false;
  };
  struct Block {
    std::uint32_t zone, source;
    bool fold;
    FieldOffsets offsets;
  };

  void reset();
  void add(const FieldEvent& event, FieldFeed& feed);
  void end_tick();
  Run run_of(std::uint32_t zone, std::uint32_t tick, std::uint64_t folded);
  std::uint32_t gather(std::uint32_t zone, std::uint64_t mask, bool fold);

  Motion motion_;
  bool lag_ = false, has_offsets_ = false;
  bool began_ = false, clear_ = false;
  std::uint32_t vertices_ = 0, stride_ = 0;
  gpu::Buffer rest_, rest_yz_, state_, coefficients_;
  gpu::GrowingBuffer sources_there_, steps_there_, offsets_there_;

  std::vector<FieldSource> source_;  // as last received
  std::uint64_t used_ = 0;
  std::vector<Zone> zone_;
  std::vector<std::uint32_t> awake_;  // zones
  std::uint64_t folded_ = 0;          // of the tick being read
  FieldSource fold_before_;
  std::vector<Block> blocks_;
  // Of all ticks since the last dispatch.
  std::vector<Row> rows_;
  std::vector<GpuSource> sources_, folds_;  // folds: now and before
  std::vector<Run> runs_;
  std::vector<vec4> offsets_;  // kZoneSize a block
};

}  // namespace pliant
