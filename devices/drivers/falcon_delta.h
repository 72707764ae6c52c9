// Kinematics of the Novint Falcon, a delta robot with three legs around its axis: after R. E. Stamper, "A three degree
// of freedom parallel manipulator with only translational degrees of freedom" (thesis, Maryland 1997), with the lengths
// that libnifalcon's authors measured.
//
// Axes: x right, y up, z out of the device towards the user; the origin is in the plane of the motors. Lengths in
// metres. In the frame of leg i (u outward, v along its motor, w = z) with P the effector's centre from the motor:
//   (P_u + c - a cos t)^2 + (P_w - a sin t)^2 = L^2,   L = d + e + b sin t3,   b cos t3 = P_v + f           (1)
// t: the leg's angle. (1) is solved for t directly, and for P by Newton's method; its differential is the Jacobian.
#pragma once

#include "pliant/math.h"

namespace pliant {

struct FalconPose {
  dvec3 angle;     // [rad] of the legs
  dmat3 jacobian;  // [rad/m] d angle / d position
};

// Leg angles at a position. False: out of reach.
bool falcon_angles(const dvec3& position, FalconPose& pose);
// The position for three angles; `position` is the initial guess and the result. False: not found.
bool falcon_position(const dvec3& angle, dvec3& position);
// Leg torques [N m] for a force [N] on the effector; false in a singular pose.
bool falcon_torques(const FalconPose& pose, const dvec3& force, dvec3& torque);

// The leg angle [rad] of an encoder count.
double falcon_angle(int count);

}  // namespace pliant
