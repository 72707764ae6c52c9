#include "systems/visual/field_replay.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "systems/touch/collide/surface_distance.h"
#include "systems/visual/gpu/desktop.h"

namespace pliant {
namespace {

// A longer stall is caught up by a copy of the stream. (llvmpipe ends a shader's loops after 65,535 turns in all, and
// a step of a law takes up to some hundred.)
constexpr std::size_t kMostTicks = 500;

constexpr std::uint64_t bit_of(std::uint32_t source) {
  return std::uint64_t{1} << source;
}

// Coefficients of a step of the law, one record of floats per vertex, or one for all (shaders/replay.comp).
std::vector<float> coefficients_of(const Motion& motion, const PaintedMotion& painted, const Mesh& mesh) {
  std::vector<float> out;
  const std::uint32_t count = painted.empty() ? 1 : mesh.vertex_count;
  for (std::uint32_t v = 0; v < count; ++v) {
    if (motion.nonlinear()) {
      out.push_back(painted.empty() ? static_cast<float>(motion.mass) : painted.mass[v]);
      out.push_back(painted.empty() ? static_cast<float>(motion.damping) : painted.damping[v]);
      if (motion.arm()) out.push_back(arm_stiffness(motion, mesh, v));
    } else if (motion.arm()) {
      for (std::size_t i = 0; i < 9; ++i)
        out.push_back(painted.empty() ? static_cast<float>(motion.solid[i / 3][i % 3]) : painted.solid[v][i]);
      out.push_back(arm_stiffness(motion, mesh, v));
    } else {
      const StepCoefficients& c = motion.linear;
      const vec4 step = painted.empty() ? vec4(c.hh, c.hv, c.vh, c.vv) : painted.linear[v];
      out.insert(out.end(), {step.x, step.y, step.z, step.w});
    }
  }
  return out;
}

template <class T>
void append(std::vector<glm::uvec4>& steps, const std::vector<T>& records) {
  static_assert(sizeof(T) % sizeof(glm::uvec4) == 0 && std::is_trivially_copyable_v<T>);
  if (records.empty()) return;
  const std::size_t first = steps.size();
  steps.resize(first + records.size() * (sizeof(T) / sizeof(glm::uvec4)));
  std::memcpy(&steps[first], records.data(), records.size() * sizeof(T));
}

}  // namespace

Result<ReplayProgram> ReplayProgram::make() {
  Result<gpu::Program> program = gpu::Program::load({"replay.comp"});
  if (!program) return program.error();
  ReplayProgram made;
  made.program_ = *std::move(program);
  return made;
}

FieldReplay::FieldReplay(const Mesh& mesh, const Deformable& deformable, double dt)
    : motion_(motion(deformable, dt)),
      lag_(deformable.response == Response::kLag),
      has_offsets_(deformable.distance == Distance::kSurface),
      vertices_(mesh.vertex_count),
      source_(64),
      zone_(mesh.zone_count()) {
  std::tie(rest_, rest_yz_) = rest_on_gpu(mesh);
  const PaintedMotion painted = paint_motion(motion_, mesh);
  const std::vector<float> coefficients = coefficients_of(motion_, painted, mesh);
  coefficients_ = gpu::Buffer::fixed(std::span<const float>(coefficients));
  stride_ = painted.empty() ? 0 : static_cast<std::uint32_t>(coefficients.size() / mesh.vertex_count);
  const bool solid = motion_.arm();
  state_ = gpu::Buffer::writable(nullptr, std::size_t{vertices_} * (solid ? 4 : 2) * sizeof(vec4));
  clear_ = true;
}

void FieldReplay::reset() {
  for (const std::uint32_t zone : awake_) zone_[zone] = {};
  awake_.clear();
  used_ = folded_ = 0;
  blocks_.clear();
  rows_.clear();
  sources_.clear();
  folds_.clear();
  runs_.clear();
  offsets_.clear();
  began_ = clear_ = true;
}

bool FieldReplay::take(FieldFeed& feed, bool fed, std::uint64_t tick) {
  if (!fed) {
    if (began_) reset();  // undrawn ticks are in the zones too
    began_ = false;
    // A new feed begins with a reset, for which there must be room.
    FieldOffsets unused;
    for (FieldEvent event; !began_ && feed.events.pop(event);) {
      if (event.kind == FieldEvent::kReset) reset();
      if (event.kind == FieldEvent::kOffsets || event.kind == FieldEvent::kFoldOffsets) feed.offsets.pop(unused);
    }
    return false;
  }
  for (FieldEvent event; feed.events.pop(event);) {
    if (event.kind == FieldEvent::kReset) reset();
    add(event, feed);
    if (event.kind == FieldEvent::kTick && event.mask >= tick) break;
  }
  if (rows_.size() > kMostTicks) {
    reset();
    began_ = false;
  }
  if (!began_) feed.wants_reset.store(true, std::memory_order_relaxed);
  return began_;
}

void FieldReplay::add(const FieldEvent& event, FieldFeed& feed) {
  const bool offsets = event.kind == FieldEvent::kOffsets || event.kind == FieldEvent::kFoldOffsets;
  Block block;
  if (offsets && !feed.offsets.pop(block.offsets)) return;
  if (!began_) return;
  switch (event.kind) {
    case FieldEvent::kReset:
      return;
    case FieldEvent::kFoldBefore:
      fold_before_ = event.source;
      return;
    case FieldEvent::kFoldNow: {
      // In the order of sources, as the shader expects.
      const auto after = 2 * std::popcount(folded_ & ~(bit_of(event.index) | (bit_of(event.index) - 1)));
      folds_.insert(folds_.end() - after, {gpu_source(event.source), gpu_source(fold_before_)});
      folded_ |= bit_of(event.index);
      return;
    }
    case FieldEvent::kSource:
      source_[event.index] = event.source;
      used_ |= bit_of(event.index);
      return;
    case FieldEvent::kZone: {
      Zone& zone = zone_[event.index];
      if (!zone.awake) {
        zone = {};
        zone.awake = true;
        awake_.push_back(event.index);
      }
      zone.next = event.mask;
      zone.flags = event.flags;
      zone.run = kNone;
      return;
    }
    case FieldEvent::kOffsets:
    case FieldEvent::kFoldOffsets:
      block.zone = event.index;
      block.source = static_cast<std::uint32_t>(event.mask);
      block.fold = event.kind == FieldEvent::kFoldOffsets;
      blocks_.push_back(block);
      return;
    case FieldEvent::kTick:
      end_tick();
      return;
  }
  UNREACHABLE();
}

std::uint32_t FieldReplay::gather(std::uint32_t zone, std::uint64_t mask, bool fold) {
  const std::uint32_t first = static_cast<std::uint32_t>(offsets_.size() / kZoneSize);
  for (; mask; mask &= mask - 1) {
    const std::uint32_t source = static_cast<std::uint32_t>(std::countr_zero(mask));
    const auto block = std::find_if(blocks_.begin(), blocks_.end(), [=](const Block& b) {
      return b.zone == zone && b.source == source && b.fold == fold;
    });
    if (block == blocks_.end()) {  // the source does not reach this zone
      offsets_.insert(offsets_.end(), kZoneSize, vec4(kFar));
      continue;
    }
    for (const vec3& offset : block->offsets.offset) offsets_.emplace_back(offset, 0.0f);
  }
  return first;
}

FieldReplay::Run FieldReplay::run_of(std::uint32_t number, std::uint32_t tick, std::uint64_t folded) {
  const Zone& zone = zone_[number];
  Run run{tick, 1, number, zone.flags, zone.next, zone.mask, 0, 0, {}};
  if (has_offsets_) {
    run.offsets = gather(number, run.mask, false);
    run.fold_offsets = gather(number, run.before & folded, true);
  }
  return run;
}

void FieldReplay::end_tick() {
  const std::uint32_t tick = static_cast<std::uint32_t>(rows_.size());
  Row row{used_, folded_, static_cast<std::uint32_t>(sources_.size()), 0, {}};
  row.first_fold = static_cast<std::uint32_t>(folds_.size()) - 2 * static_cast<std::uint32_t>(std::popcount(folded_));
  for (std::uint64_t bits = used_; bits; bits &= bits - 1)
    sources_.push_back(gpu_source(source_[static_cast<std::size_t>(std::countr_zero(bits))]));
  rows_.push_back(row);
  for (std::size_t i = 0; i < awake_.size();) {
    const std::uint32_t number = awake_[i];
    Zone& zone = zone_[number];
    if (zone.run == kNone || (has_offsets_ && (zone.next | zone.mask))) {
      zone.run = static_cast<std::uint32_t>(runs_.size());
      runs_.push_back(run_of(number, tick, folded_));
    } else {
      ++runs_[zone.run].count;
    }
    zone.mask = zone.next;
    if (zone.flags) zone.run = kNone;
    const bool sleeps = zone.flags & FieldEvent::kSleeps;
    zone.flags = 0;
    if (!sleeps) {
      ++i;
      continue;
    }
    zone = {};
    awake_[i] = awake_.back();
    awake_.pop_back();
  }
  folded_ = 0;
  blocks_.clear();
}

std::size_t FieldReplay::evaluate(const ReplayProgram& program, const gpu::Buffer& stream) {
  if (clear_) gpu::desktop::clear(state_.id());
  clear_ = false;
  if (runs_.empty()) {
    rows_.clear();
    sources_.clear();
    folds_.clear();
    return 0;
  }
  // Runs of a zone are adjacent, in order of time; one work group per zone.
  std::stable_sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.zone < b.zone; });
  std::vector<glm::uvec4> zones;  // first run, number of runs
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    if (i == 0 || runs_[i].zone != runs_[i - 1].zone) zones.emplace_back(i, 0, 0, 0);
    ++zones.back().y;
  }
  for (Row& row : rows_) row.first_fold += static_cast<std::uint32_t>(sources_.size());
  sources_.insert(sources_.end(), folds_.begin(), folds_.end());
  std::vector<glm::uvec4> steps;
  append(steps, rows_);
  const std::uint32_t first_run = static_cast<std::uint32_t>(steps.size());
  append(steps, runs_);
  const std::uint32_t first_zone = static_cast<std::uint32_t>(steps.size());
  append(steps, zones);
  const std::size_t travelled = sources_there_.write(std::span<const GpuSource>(sources_)) +
                                steps_there_.write(std::span<const glm::uvec4>(steps)) +
                                offsets_there_.write(std::span<const vec4>(offsets_));

  program.program_.use();
  const GLuint id = program.program_.id();
  const auto whole = [&](const char* name, std::uint32_t value) {
    glUniform1ui(glGetUniformLocation(id, name), value);
  };
  const auto number = [&](const char* name, double value) {
    glUniform1f(glGetUniformLocation(id, name), static_cast<float>(value));
  };
  whole("vertex_count", vertices_);
  whole("law", static_cast<std::uint32_t>(motion_.law.kind));
  whole("way", static_cast<std::uint32_t>(row_of(motion_.law.kind).step));
  whole("lags", lag_);
  whole("has_offsets", has_offsets_);
  whole("stride", stride_);
  whole("first_run", first_run);
  whole("first_zone", first_zone);
  number("dt", motion_.dt);
  number("inv_dt", 1 / motion_.dt);
  number("cubic", motion_.law.cubic);
  number("stiffening", motion_.law.stiffening);
  vec4 place[ForceTable::kMost] = {}, curve[ForceTable::kMost] = {};
  for (std::uint32_t i = 0; i < motion_.law.table.count; ++i) {
    const CubicPiece& p = motion_.law.table.piece[i];
    place[i] = vec4(p.at, p.value, p.slope, p.second);
    curve[i] = vec4(p.third, p.integral, 0, 0);
  }
  glUniform1i(glGetUniformLocation(id, "table_count"), static_cast<GLint>(motion_.law.table.count));
  glUniform4fv(glGetUniformLocation(id, "table_place"), ForceTable::kMost, &place[0].x);
  glUniform4fv(glGetUniformLocation(id, "table_curve"), ForceTable::kMost, &curve[0].x);
  number("arm_decay", motion_.arm_decay);
  number("arm_half", motion_.arm_half);
  number("arm_ramp", motion_.arm_time / motion_.dt * (1 - motion_.arm_decay));
  const GLuint bindings[] = {stream.id(),        rest_.id(),          rest_yz_.id(),     state_.id(),
                             coefficients_.id(), sources_there_.id(), steps_there_.id(), offsets_there_.id()};
  for (GLuint i = 0; i < std::size(bindings); ++i) gpu::desktop::bind_storage(i, bindings[i]);
  gpu::desktop::dispatch(static_cast<GLuint>(zones.size()));

  rows_.clear();
  sources_.clear();
  folds_.clear();
  runs_.clear();
  offsets_.clear();
  for (const std::uint32_t zone : awake_) zone_[zone].run = kNone;
  return travelled;
}

}  // namespace pliant
