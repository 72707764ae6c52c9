#include "engine/run/limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "components/soft_body.h"
#include "engine/run/stiffness_note.h"
#include "runtime/assert.h"
#include "systems/device/hands.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// Properties of a force or a torque for its sentence.
struct Quantity {
  const char* name;
  const char* limit;    // key of its largest value
  const char* unit;     // unit of that key
  double largest;       // [N] or [N m]
  double slew;          // [N/s] or [N m/s]
  double stiffness;     // [N/m] 0: none
  const char* smaller;  // threshold below which the gate opens
};

Note note_of(SafetyLimit limit, const LimitCount& count, const std::string& who, const Quantity& q) {
  const std::string ticks = fmt::format("{} tick{}", count.ticks, count.ticks == 1 ? "" : "s");
  const std::string percent = fmt::format("{:.3g} %", 100 * count.largest_share);
  Note note;
  note.code = fmt::format("{}.{}", q.name, key_of(limit));
  switch (limit) {
    case SafetyLimit::kClipped:
      note.what = fmt::format("{}: the {} was clipped at {} {:g} {} in {} (at most {} less than the law says)", who,
                              q.name, q.limit, q.largest, q.unit, ticks, percent);
      note.cure = fmt::format("raise {} where the device can render it", q.limit);
      return note;
    case SafetyLimit::kWithheld:
      note.what = fmt::format(
          "{}: the {} was damped in {} (by at most {} of what the law says), because the hand would have got more "
          "energy than it gave",
          who, q.name, ticks, percent);
      note.cure = "raise the rate, or refine and smooth the mesh where it is touched";
      return note;
    case SafetyLimit::kGated:
      note.what = fmt::format("{}: no {} was sent in {}: the safety gate opens once less than {} is computed", who,
                              q.name, ticks, q.smaller);
      note.cure = "start outside the object";
      return note;
    case SafetyLimit::kSlewed:
      note.what = fmt::format(
          "{}: the {} changed faster than max_slew {:g} {}/s{} let it in {} (off by at most {})", who, q.name, q.slew,
          q.unit, q.stiffness > 0 ? fmt::format(" and max_stiffness {:g} N/m", q.stiffness) : "", ticks, percent);
      note.cure = q.stiffness > 0
                      ? "move slower, or raise the one of the two that is met, where the device can render it"
                      : "move slower, or raise max_slew where the device can render it";
      return note;
  }
  UNREACHABLE();
}

void explain(const SafetyTally& tally, const std::string& who, const std::string& name, const Quantity& quantity,
             std::vector<Note>& notes) {
  for (std::size_t i = 0; i < kSafetyLimits; ++i) {
    if (tally.counts[i].ticks == 0) continue;
    notes.push_back(note_of(static_cast<SafetyLimit>(i), tally.counts[i], who, quantity));
    notes.back().of = name;
  }
}

}  // namespace

std::uint8_t HandSafety::now() const {
  return static_cast<std::uint8_t>((force ? force->tally.now : 0) | (torque ? torque->tally.now : 0));
}

HandSafety find_safety(const World& world, Entity hand) {
  if (world.touch)
    for (const ProbeState& probe : world.touch->probes)
      if (probe.entity == hand) return {&probe.safety, probe.lever > 0 ? &probe.torque_safety : nullptr};
  if (world.tools)
    for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools)
      if (tool->entity == hand) return {&tool->force_safety, &tool->torque_safety};
  return {};
}

std::vector<Note> explain_limits(const World& world, Entity hand, const std::string& name) {
  std::vector<Note> notes;
  const HandSafety safety = find_safety(world, hand);
  const HapticDevice* device = find_device(world, hand);
  if (!safety.force || !device) return notes;
  const SafetyLimits force = force_limits(*device);
  const Handle6* const handle = world.registry.find<Handle6>(hand);
  const std::string who = (handle ? "tool `" : "probe `") + name + "`";
  explain(safety.force->tally, who, name,
          {"force", "max_force", "N", force.force, force.slew, force.stiffness / force.scale, "0.2 N"}, notes);
  if (std::optional<Note> softened = softened_note(world, hand, name, safety.force->least_share))
    notes.push_back(std::move(*softened));
  for (std::size_t i = 0; world.touch && i < world.touch->probes.size(); ++i)
    if (const ProbeState& probe = world.touch->probes[i]; probe.entity == hand && probe.stiffened_sum > 0.0)
      notes.push_back({fmt::format("{}: what it pressed grew stiffer in time and so gained {:.3g} mJ, which may push "
                                   "the hand",
                                   who, 1e3 * probe.stiffened_sum),
                       "lower the rise of the animated `stiffness`, if that is not meant", "force.stiffened", name});
  if (!safety.torque) return notes;
  const SafetyLimits torque = handle ? torque_limits(*device, *handle) : probe_torque_limits(*device);
  explain(safety.torque->tally, who, name,
          {"torque", handle ? "max_torque" : "max_force", "N m", torque.force, torque.slew, 0.0, "0.2 N m"}, notes);
  return notes;
}

const char* key_of(SafetyLimit limit) {
  switch (limit) {
    case SafetyLimit::kClipped:
      return "clipped";
    case SafetyLimit::kWithheld:
      return "withheld";
    case SafetyLimit::kGated:
      return "gated";
    case SafetyLimit::kSlewed:
      return "slewed";
  }
  UNREACHABLE();
}

}  // namespace pliant
