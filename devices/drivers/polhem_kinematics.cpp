#include "devices/drivers/polhem_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// Device axes (towards the user, right, up) to world (right, up, towards the user).
dvec3 world_of(const dvec3& v) {
  return {v.y, v.z, v.x};
}

// Body angle per radian of its motor, signed.
dvec3 ratio(const PolhemConfig& config) {
  return config.sign * config.capstan / config.body;
}

}  // namespace

// Constants: haptikfabrikenapi.h (its BSD-licensed header); max_current at the amplifiers' full signal.
const std::array<PolhemConfig, 4> kPolhemConfigs{{
    {"polhem_v1",
     {.010, .010, .010},
     {.180, .100, .100},
     .058,
     .174,
     .133,
     {.140, 0, .100},
     .100,
     {.0538, .0538, .0538},
     {2000, 2000, 2000},
     {1024, 1024, 1024},
     5.0,
     800.0,
     3.0,
     {0, 0, -5000, 0, 0, 0},
     {-1, -1, -1},
     {-1, 1, -1}},
    {"woodenhaptics_v2015",
     {.010, .010, .010},
     {.160, .120, .120},
     .080,
     .205,
     .245,
     {.220, 0, .080},
     .100,
     {.0259, .0259, .0259},
     {2000, 2000, 2000},
     {0, 0, 0},
     5.0,
     1000.0,
     3.0,
     {0, 0, 6000, 0, 0, 0},
     {1, 1, 1},
     {-1, -1, -1}},
    {"aluhaptics_v2",
     {.0138, .0098, .0098},
     {.116, .076, .076},
     .111,
     .140,
     .111,
     {.140, 0, 0},
     .100,
     {.0259, .0259, .0259},
     {2000, 2000, 2000},
     {0, 0, 0},
     5.0,
     1000.0,
     3.0,
     {0, 0, 0, 0, 0, 0},
     {1, 1, 1},
     {-1, -1, -1}},
    {"vintage",
     {.013, .010, .010},
     {.117, .077, .077},
     .056,
     .138,
     .112,
     {.140, 0, 0},
     .100,
     {.0163, .0163, .0163},
     {4000, 4000, 4000},
     {0, 0, 0},
     5.0,
     800.0,
     3.0,
     {0, 0, 0, 0, 0, 0},
     {1, 1, 1},
     {-1, 1, 1}},
}};

dvec3 polhem_angles(const PolhemConfig& config, const std::array<std::int16_t, 6>& counts) {
  return ratio(config) * kTurn * dvec3(counts[0], counts[1], counts[2]) / config.counts;
}

dvec3 polhem_position(const PolhemConfig& config, const dvec3& q) {
  const double reach = config.lb * std::sin(q.y) + config.lc * std::sin(q.z);
  const double height = config.la + config.lb * std::cos(q.y) - config.lc * std::cos(q.z);
  return world_of(dvec3(reach * std::cos(q.x), reach * std::sin(q.x), height) - config.origin);
}

dmat3 polhem_jacobian(const PolhemConfig& config, const dvec3& q) {
  const double reach = config.lb * std::sin(q.y) + config.lc * std::sin(q.z);
  const dvec3 outward(std::cos(q.x), std::sin(q.x), 0), around(-std::sin(q.x), std::cos(q.x), 0), up(0, 0, 1);
  return {world_of(reach * around), world_of(config.lb * (std::cos(q.y) * outward - std::sin(q.y) * up)),
          world_of(config.lc * (std::cos(q.z) * outward + std::sin(q.z) * up))};
}

PolhemPose polhem_pose(const PolhemConfig& config, const std::array<std::int16_t, 6>& counts) {
  const dvec3 q = polhem_angles(config, counts);
  PolhemPose pose;
  pose.position = polhem_position(config, q);
  if (config.turn_counts.x == 0.0) return pose;
  // The gimbal rotates about the forearm, across it, and about the pen; in device axes x, y, x, on body A and C.
  const dvec3 gimbal = config.turn_sign * kTurn * dvec3(counts[3], counts[4], counts[5]) / config.turn_counts;
  const dquat turned = glm::angleAxis(q.x, dvec3(0, 0, 1)) *
                       glm::angleAxis(std::numbers::pi / 2 - q.z, dvec3(0, 1, 0)) *
                       glm::angleAxis(gimbal.x, dvec3(1, 0, 0)) * glm::angleAxis(gimbal.y, dvec3(0, 1, 0)) *
                       glm::angleAxis(gimbal.z, dvec3(1, 0, 0));
  pose.rotation = glm::normalize(dquat(turned.w, turned.y, turned.z, turned.x));  // the same rotation in world axes
  return pose;
}

dvec3 polhem_currents(const PolhemConfig& config, const dvec3& q, const dvec3& force) {
  const dvec3 torque = glm::transpose(polhem_jacobian(config, q)) * force;
  const dvec3 current = torque * ratio(config) / config.torque_constant;
  const double most = std::max({std::abs(current.x), std::abs(current.y), std::abs(current.z)});
  if (!std::isfinite(most)) return dvec3(0);
  return most > config.max_current ? current * (config.max_current / most) : current;
}

dvec3 polhem_force(const PolhemConfig& config, const dvec3& q, const dvec3& currents) {
  const dvec3 torque = currents * config.torque_constant / ratio(config);
  return glm::inverse(glm::transpose(polhem_jacobian(config, q))) * torque;
}

}  // namespace pliant
