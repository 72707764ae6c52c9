#include "viewer/hand/camera_control.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kFollowTime = 0.08;  // [s] time constant of the camera's smoothing
constexpr double kOrbitTurn = 3.6;    // [rad] over the height of the picture
constexpr double kZoomStep = 0.87;    // [1] of the distance
constexpr double kSteepest = 1.55;    // [rad] of elevation: looking straight down leaves the azimuth undefined
constexpr double kNearest = 0.05, kFarthestAway = 20.0;  // [1] of the scene's size

}  // namespace

ViewRay ray_through(const Viewpoint& view, double x, double y, int width, int height) {
  const dvec3 forward = normalize(view.target - view.eye);
  const dvec3 right = normalize(cross(forward, view.up)), up = cross(right, forward);
  const double slope = std::tan(0.5 * static_cast<double>(view.yfov));
  const double aspect = static_cast<double>(width) / height;
  return {view.eye,
          normalize(forward + (2 * x / width - 1) * aspect * slope * right + (1 - 2 * y / height) * slope * up)};
}

CameraControl::CameraControl(const Viewpoint& home, const Box& scene) : scene_(scene), yfov_(home.yfov) {
  size_ = scene.empty() ? 1.0 : std::max(1e-6, static_cast<double>(scene.diagonal()));
  const dvec3 back = home.eye - home.target;
  home_.target = home.target;
  home_.distance = std::max(length(back), 1e-9);
  home_.azimuth = std::atan2(back.x, back.z);
  home_.elevation = std::clamp(std::asin(std::clamp(back.y / home_.distance, -1.0, 1.0)), -kSteepest, kSteepest);
  goal_ = shown_ = home_;
}

CameraControl CameraControl::before(const Box& scene) {
  Box box = scene;
  if (box.empty() || !(box.diagonal() > 0.0f)) box.add(Box{vec3(-0.1f), vec3(0.1f)});
  const dvec3 center(box.center());
  constexpr float kYfov = 0.7f;  // [rad]
  const double away = 0.62 * static_cast<double>(box.diagonal()) / std::sin(0.5 * static_cast<double>(kYfov));
  return {Viewpoint{center + away * glm::normalize(dvec3(0.45, 0.38, 1.0)), center, {0, 1, 0}, kYfov}, box};
}

void CameraControl::orbit(double dx, double dy, int height) {
  goal_.azimuth -= kOrbitTurn * dx / height;
  goal_.elevation = std::clamp(goal_.elevation + kOrbitTurn * dy / height, -kSteepest, kSteepest);
}

// A point at the target's distance stays under the cursor.
void CameraControl::pan(double dx, double dy, int height) {
  const Viewpoint view = at(goal_, yfov_);
  const dvec3 forward = normalize(view.target - view.eye);
  const dvec3 right = normalize(cross(forward, view.up)), up = cross(right, forward);
  const double pixel = 2 * goal_.distance * std::tan(0.5 * static_cast<double>(yfov_)) / height;  // [m]
  goal_.target += pixel * (dy * up - dx * right);
}

void CameraControl::zoom(double steps) {
  goal_.distance = std::clamp(goal_.distance * std::pow(kZoomStep, steps), kNearest * size_, kFarthestAway * size_);
}

void CameraControl::look_from(double azimuth, double elevation) {
  goal_.azimuth = azimuth + 2 * glm::pi<double>() * std::round((goal_.azimuth - azimuth) / (2 * glm::pi<double>()));
  goal_.elevation = std::clamp(elevation, -kSteepest, kSteepest);
}

void CameraControl::frame() {
  if (!scene_.empty()) goal_.target = dvec3(scene_.center());
  goal_.distance = 0.5 * size_ / std::sin(0.5 * static_cast<double>(yfov_));
}

void CameraControl::frame(const Box& box) {
  if (box.empty()) return;
  scene_ = box;
  size_ = std::max(1e-6, static_cast<double>(box.diagonal()));
  frame();
}

bool CameraControl::moving() const {
  return length(goal_.target - shown_.target) > 1e-4 * goal_.distance ||
         std::abs(goal_.distance / shown_.distance - 1.0) > 1e-4 || std::abs(goal_.azimuth - shown_.azimuth) > 1e-4 ||
         std::abs(goal_.elevation - shown_.elevation) > 1e-4;
}

void CameraControl::home() {
  goal_ = home_;
}

void CameraControl::update(double dt) {
  if (!moving()) {  // snap to the goal, so that redrawing ends
    shown_ = goal_;
    return;
  }
  const double share = 1 - std::exp(-std::max(dt, 0.0) / kFollowTime);
  shown_.target += share * (goal_.target - shown_.target);
  shown_.distance *= std::pow(goal_.distance / shown_.distance, share);
  shown_.azimuth += share * (goal_.azimuth - shown_.azimuth);
  shown_.elevation += share * (goal_.elevation - shown_.elevation);
}

Viewpoint CameraControl::at(const Pose& pose, float yfov) {
  const dvec3 back(std::cos(pose.elevation) * std::sin(pose.azimuth), std::sin(pose.elevation),
                   std::cos(pose.elevation) * std::cos(pose.azimuth));
  return {.eye = pose.target + pose.distance * back, .target = pose.target, .up = dvec3(0, 1, 0), .yfov = yfov};
}

Viewpoint CameraControl::viewpoint() const {
  return at(shown_, yfov_);
}

}  // namespace pliant
