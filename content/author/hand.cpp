#include "content/author/hand.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant::solids {
namespace {

constexpr double kBlend = 0.005;   // [m] radius of the blend between a finger and the palm
constexpr double kWaist = 0.0012;  // [m] by which a finger is thinner halfway between two joints

// A digit: three joints in a row, thinner between them and towards the tip.
struct Digit {
  std::array<dvec3, 4> joint;    // [m] from the root, inside the palm, to the tip
  std::array<double, 4> radius;  // [m]
};

// Straight along `heading` (from -Z towards +X) and curling down joint by joint. Angles in degrees.
Digit make_digit(dvec3 root, double heading, std::array<double, 3> lengths, std::array<double, 3> curl, double thick) {
  Digit digit{{root}, {1.04 * thick, 1.06 * thick, 1.0 * thick, 0.84 * thick}};
  double down = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    down += glm::radians(curl[i]);
    const double h = glm::radians(heading);
    const dvec3 along(std::cos(down) * std::sin(h), -std::sin(down), -std::cos(down) * std::cos(h));
    digit.joint[i + 1] = digit.joint[i] + lengths[i] * along;
  }
  return digit;
}

// Approximate distance to a capsule with radius ra at one end and rb at the other, thinner by `waist` halfway.
double bone(dvec3 p, dvec3 a, dvec3 b, double ra, double rb, double waist) {
  const dvec3 ab = b - a;
  const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
  const double halfway = std::sin(glm::pi<double>() * t);
  return length(p - a - t * ab) - glm::mix(ra, rb, t) + waist * halfway * halfway;
}

// The last segment has no waist: it ends in the fingertip.
double digit_distance(dvec3 p, const Digit& digit) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < 3; ++i)
    nearest = std::min(nearest, bone(p, digit.joint[i], digit.joint[i + 1], digit.radius[i], digit.radius[i + 1],
                                     i < 2 ? kWaist : 0.0));
  return nearest;
}

// The knuckle where a finger leaves the palm: a low bump on the back of the hand.
double knuckle(dvec3 p, const Digit& finger) {
  return length(p - finger.joint[0] - dvec3(0, 0.0045, -0.004)) - finger.radius[0] - 0.0008;
}

// A box with edges rounded over its whole thickness, slightly cupped towards the fingers.
double palm(dvec3 p) {
  const dvec3 half(0.046, 0.013, 0.042);
  const double taper = 1.0 - 0.22 * std::clamp((p.z + 0.01) / 0.06, 0.0, 1.0);  // narrower at the wrist
  const dvec3 q = glm::abs(dvec3(p.x / taper, p.y, p.z)) - (half - dvec3(half.y));
  return length(glm::max(q, dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - half.y;
}

// Smooth minimum: rounded where the two are close; never larger than either.
double join(double a, double b) {
  const double h = std::max(kBlend - std::abs(a - b), 0.0) / kBlend;
  return std::min(a, b) - 0.25 * kBlend * h * h;
}

// The fingers from the index on, then the thumb.
std::array<Digit, 5> hand_digits() {
  return {{make_digit({-0.036, 0.0, -0.030}, -9.0, {0.044, 0.026, 0.020}, {6.0, 16.0, 14.0}, 0.0088),
           make_digit({-0.012, 0.001, -0.032}, -2.0, {0.048, 0.029, 0.021}, {5.0, 15.0, 14.0}, 0.0092),
           make_digit({0.012, 0.001, -0.032}, 4.0, {0.046, 0.027, 0.021}, {6.0, 16.0, 14.0}, 0.0088),
           make_digit({0.035, -0.001, -0.030}, 12.0, {0.038, 0.021, 0.018}, {8.0, 18.0, 14.0}, 0.0082),
           make_digit({-0.030, -0.004, 0.014}, -52.0, {0.034, 0.026, 0.022}, {14.0, 10.0, 8.0}, 0.0100)}};
}

}  // namespace

Solid hand_solid() {
  const std::array<Digit, 5> digits = hand_digits();
  return [digits](dvec3 p) {
    const double middle = palm(p);
    double nearest = middle;
    for (const Digit& digit : digits) nearest = std::min(nearest, join(middle, digit_distance(p, digit)));
    for (std::size_t finger = 0; finger < 4; ++finger)
      nearest = std::min(nearest, join(middle, knuckle(p, digits[finger])));
    return nearest;
  };
}

std::array<std::array<dvec3, 4>, 5> hand_joints() {
  const std::array<Digit, 5> digits = hand_digits();
  std::array<std::array<dvec3, 4>, 5> out;
  for (std::size_t i = 0; i < 5; ++i) out[(i + 1) % 5] = digits[i].joint;
  return out;
}

Box hand_box() {
  return {{-0.12f, -0.075f, -0.16f}, {0.09f, 0.03f, 0.06f}};
}

Box hand_bone() {
  return {{-0.05f, -0.02f, -0.016f}, {0.05f, 0.02f, 0.06f}};
}

}  // namespace pliant::solids
