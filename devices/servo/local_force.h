// A force model (pliant/driver.h: DeviceModel) where a device is now.
#pragma once

#include "pliant/driver.h"

namespace pliant {

// `since`: [s] the model's age; what is touched has gone on by its velocity. Of a surface the force does not turn round
// where the device leaves it: it ends.
DeviceWrench local_force(const DeviceModel& model, dvec3 position, dquat rotation, dvec3 velocity, dvec3 spin,
                         double since);

// Nothing: no force, and none anywhere near.
bool is_nothing(const DeviceModel& model);

// The model with its stiffness by position lowered to `most` [N/m]; 0: as it is.
DeviceModel softened(const DeviceModel& model, double most);

}  // namespace pliant
