#include "player/run/tool_words.h"

#include <fmt/format.h>

#include "systems/soft/soft_state.h"
#include "systems/soft/under_gravity.h"
#include "systems/tool/begun_inside.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

constexpr double kSaidLimited = 0.01;   // [s]
constexpr std::size_t kSaidBroken = 3;  // joints by name
constexpr double kSaidApart = 0.02;     // [1] of the size of a joint
constexpr double kSaidResidual = 1e-4;  // [m/s] slower creep is invisible
constexpr double kSaidLoss = 0.02;      // [1] of the run: a smaller loss occurs while the first step compares solvers

std::string body_name(const World& world, std::uint32_t body) {
  const Entity entity = world.soft->bodies[body]->entity;
  const Name* name = world.registry.find<Name>(entity);
  return name ? "`" + name->value + "`" : fmt::format("body {}", body);
}

// Of a tool or probe; null: it has none.
const HapticDevice* grip_device(const World& world, Entity hand) {
  const ToolTouchState* const tool = hand == kNoEntity ? nullptr : find_tool(world, hand);
  return tool ? &world.registry.get<HapticDevice>(tool->device) : nullptr;
}

// [s] Mean age of a force that is held and fades in, in lockstep: sensed a tick ago, kept for a soft step.
double age_of_held(const Simulation& s) {
  const double tick = 1.0 / s.touch_rate;
  return tick + (s.soft_step > tick ? 0.5 * (1.0 + kJoinShare) * s.soft_step : 0.5 * tick);
}

// A spring k whose force is that old pushes a hand on like a damping of -k age.
void explain_held(const World& world, const std::string& name, std::vector<Note>& notes) {
  const Entity tool = find_by_name(world, name);
  const Handle6* const handle = tool == kNoEntity ? nullptr : world.registry.find<Handle6>(tool);
  if (!handle || handle->force != ToolForce::kHeld) return;
  const auto [k, b] = handle->translation;
  const double least = k * age_of_held(world.simulation);
  if (b >= least) return;
  notes.push_back({fmt::format("tool `{}`: its held force is {:.3g} ms old on average, and pushes the hand on unless "
                               "the hand damps more than {:.2g} N s/m",
                               name, 1e3 * age_of_held(world.simulation), least - b),
                   fmt::format("use --tool-force contacts, make soft_step shorter, or raise the damping of its "
                               "`coupling.translation` to {:.2g}",
                               least),
                   "tool.held", name});
}

std::string count(std::uint64_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace

std::vector<Note> explain_tool(const World& world, const ProbeSummary& summary) {
  std::vector<Note> notes;
  if (summary.late_ticks > 0)
    notes.push_back(
        {fmt::format("tool `{}`: the contact solve exceeded its time budget in {}; after {} such ticks in a "
                     "row the linear model was used",
                     summary.name, count(summary.late_ticks, "tick"), kLateTicks),
         "lower --rate, or use --tool-force linear", "tool.late", summary.name});
  if (summary.stale_ticks > 0)
    notes.push_back(
        {fmt::format("tool `{}`: in {} its model was older than {:g} soft steps ({:.3g} s), so its force faded",
                     summary.name, count(summary.stale_ticks, "tick"), kStaleSteps,
                     kStaleSteps * world.simulation.soft_step),
         "lower --rate, make its `cell` larger, or make soft_step longer", "tool.stale", summary.name});
  explain_held(world, summary.name, notes);
  return notes;
}

std::vector<Note> explain_soft_steps(const World& world, const SoftFigures& figures) {
  std::vector<Note> notes;
  const auto add = [&](const char* code, std::string what, std::string cure) {
    notes.push_back({std::move(what), std::move(cure), code, {}});
  };
  const SoftTally& tally = world.soft->tally;
  if (tally.contacts_cut > 0)
    add("soft.contacts_cut",
        count(tally.contacts_cut, "contact") + (tally.contacts_cut == 1 ? " was" : " were") +
            " dropped because a soft step was full",
        "press with a smaller area, or coarsen the meshes in contact");
  if (tally.began_inside > 0.0)
    add("soft.began_inside",
        fmt::format("{} and {} begin {:.2f} mm inside each other{}", body_name(world, tally.inside_a),
                    body_name(world, tally.inside_b), tally.began_inside * 1e3,
                    begins_without_contact(*world.soft->bodies[tally.inside_a], *world.soft->bodies[tally.inside_b])
                        ? ", and the first touches nothing until it has left"
                    : world.soft->bodies[tally.inside_a]->kind == BodyKind::kProbe
                        ? ", where the probe is not felt as from outside"
                        : " and are pushed apart"),
        "move one of them in the level");
  if (tally.halted_for > 0.0)
    add("soft.halted",
        fmt::format("bodies were stopped for {:.3g} s in total, in soft steps in which they would have passed through "
                    "each other",
                    tally.halted_for),
        "make soft_step shorter, or press more slowly");
  if (tally.unconverged > 0 && tally.residual > kSaidResidual)
    add("soft.unconverged",
        fmt::format("{} of {} ended unconverged (residual at most {:.2g} m/s), so what is gripped or stacked may creep",
                    tally.unconverged, count(figures.steps, "soft step"), tally.residual),
        "make soft_step shorter, or give bodies in contact more similar masses and stiffnesses");
  const Joints& joints = world.soft->joints;
  std::size_t broken = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointReport& joint = joints.report(i);
    if (joint.broke_at >= 0.0 && ++broken <= kSaidBroken)
      add("joint.broke",
          fmt::format("joint `{}` broke at {:.3f} s, under {:.3g} N", joints.name(i), joint.broke_at, joint.largest),
          "raise its `strength`, or pull less");
    if (joint.limited_for > kSaidLimited)
      add("joint.limited",
          fmt::format("joint `{}` was driven with its `max_force` for {:.3g} s, so that it did not follow its target",
                      joints.name(i), joint.limited_for),
          "raise its `max_force`, or lower its `stiffness`");
    if (const HapticDevice* const device = grip_device(world, joints.joint(i).hand); device && !device->grips)
      add("joint.no_grip",
          fmt::format("joint `{}` is driven by the grip of `{}`, whose device senses none: it stays open",
                      joints.name(i), joints.joint(i).grip),
          "use a device with a grip (`pliant devices`), or a script with a column `grip`");
    if (joint.apart > kSaidApart * joints.arm(i))
      add("joint.apart",
          fmt::format("joint `{}` came {:.3g} mm apart: its bodies turned too far within a soft step", joints.name(i),
                      joint.apart * 1e3),
          "make soft_step shorter, or the masses of joined bodies more similar");
  }
  if (broken > kSaidBroken)
    add("joint.broke", fmt::format("{} more joints broke", broken - kSaidBroken),
        "raise their `strength`, or pull less");
  for (Note& note : explain_sag(world)) notes.push_back(std::move(note));
  const double kept = static_cast<double>(figures.steps) * world.simulation.soft_step;  // [s] lower bound
  if (figures.time_lost > kSaidLoss * (kept + figures.time_lost))
    add("soft.time_lost",
        fmt::format("the soft clock did not keep up: bodies are {:.2f} s behind after {} of {:g} s", figures.time_lost,
                    count(figures.steps, "step"), world.simulation.soft_step),
        "make `cell` larger or soft_step longer, or leave out --realtime");
  return notes;
}

}  // namespace pliant
