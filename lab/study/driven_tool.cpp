#include "lab/study/driven_tool.h"

#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {

void drive_tool(World& world, const Pose& now, const Pose& before, double T, double time, const RigidMotion* handle) {
  ToolTouchState& tool = *world.tools->tools[0];
  ToolInput& input = tool.input.write();
  const dvec3 turn = vector_of(now.rotation * glm::conjugate(before.rotation));
  input.status = DeviceStatus::kReady;
  input.time = time;
  input.device = {now, join((now.position - before.position) / T, turn / T)};
  input.placed = handle != nullptr;
  if (handle) input.handle = *handle;
  input.impulse = tool.heard + T * tool.pending.force;  // expected impulse: from the last step
  tool.input.publish();
}

}  // namespace pliant
