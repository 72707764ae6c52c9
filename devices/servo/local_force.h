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

// [N/m] How much less there is of `wanted` per metre along it; 0 where nothing is wanted, or it does not grow less.
double stiffness_along(const dmat3& by_position, dvec3 wanted);

// What a device may be told that renders the model itself, and may lose every frame after this one: `model` with the
// wrench `sent` that left at its pose, which is changed by position alone, by `share` [1] of its slope, and that along
// the force where the whole slope would not keep to `most` [N]. Turns and speeds have no bound when frames are lost;
// nor is it told the slope of what moves: that is not where it was any more, and its force stays as it is.
DeviceModel told_elsewhere(const DeviceModel& model, const DeviceWrench& sent, double share, double most);

// [m] How far from its position a model may change: so far that its force stays below `most` [N], 0: below kUsualForce.
// Beyond, it is the force at that distance.
inline constexpr double kFarthestModel = 0.1;  // [m]
double model_radius(const DeviceModel& model, double most);

}  // namespace pliant
