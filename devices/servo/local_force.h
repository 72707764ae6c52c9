// Evaluates a force model (pliant/driver.h: DeviceModel) at a device's current pose.
#pragma once

#include "pliant/driver.h"

namespace pliant {

// `since`: [s] age of the model; the touched object is extrapolated by its velocity. For a surface, the force ends
// where the device leaves it instead of reversing.
DeviceWrench local_force(const DeviceModel& model, dvec3 position, dquat rotation, dvec3 velocity, dvec3 spin,
                         double since);

// True: zero force, here and nearby.
bool is_nothing(const DeviceModel& model);

// The model with its position stiffness lowered to `most` [N/m]; 0: unchanged.
DeviceModel softened(const DeviceModel& model, double most);

// [N/m] Decrease of `wanted` per metre along it; 0 if nothing is wanted, or it does not decrease.
double stiffness_along(const dmat3& by_position, dvec3 wanted);

// The model for a device that renders it itself and may lose every later frame: `model` with the wrench `sent` at its
// pose. The force varies with position only, by `share` [1] of the slope; along the force the slope is limited so that
// it stays below `most` [N]. Rotation and velocity terms are omitted, because they have no bound when frames are lost.
// For a moving object the slope is omitted too: it would not be where the model puts it, and the force stays constant.
DeviceModel rendered_elsewhere(const DeviceModel& model, const DeviceWrench& sent, double share, double most);

// [m] Range within which a model may vary: its force stays below `most` [N]; 0: below kUsualForce. Beyond it the force
// is that at this distance.
inline constexpr double kFarthestModel = 0.1;  // [m]
double model_radius(const DeviceModel& model, double most);

}  // namespace pliant
