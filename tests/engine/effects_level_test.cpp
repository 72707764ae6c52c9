// The six plates of content/levels/effects.glb can be distinguished by the forces of a stroke alone: nearest mean over
// five numbers, learnt from some strokes and tried on others of other depths, speeds and directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pliant/content.h"
#include "pliant/session.h"

namespace pliant {
namespace {

const char* const kPlateNames[] = {"glass", "rubber", "rosin", "sandpaper", "studs", "bell"};
constexpr std::size_t kPlates = std::size(kPlateNames), kFeatures = 5;
using Features = std::array<double, kFeatures>;

struct Stroke {
  double depth, strike, slow, fast, angle;  // [m] [m/s] [m/s] [m/s] [rad]
};
constexpr double kTip = 0.0015, kHalf = 0.014;  // [m]
constexpr double kStill = 0.3, kSettled = 0.5;  // [s]

dvec3 middle_of_plate(std::size_t plate) {
  return {0.06 * (static_cast<double>(plate % 3) - 1.0), 0.0, 0.06 * (static_cast<double>(plate / 3) - 0.5)};
}

struct Phases {
  double touches, slow_from, slow_to, fast_from, fast_to;  // [s]
};
Path path_of(const Stroke& s, std::size_t plate, Phases& at) {
  const dvec3 middle = middle_of_plate(plate), along(std::cos(s.angle), 0, std::sin(s.angle));
  const auto place = [&](double way, double height) { return middle + way * along + dvec3(0, kTip + height, 0); };
  Path path;
  double t = 0.0;
  const auto go = [&](double seconds, double way, double height) {
    t += seconds;
    path.rows.push_back({t, place(way, height), dquat(1, 0, 0, 0)});
  };
  go(0.0, -kHalf, 0.01);
  go(kStill, -kHalf, 0.01);
  go(0.01 / s.strike, -kHalf, 0.0);
  at.touches = t;
  go(s.depth / s.strike, -kHalf, -s.depth);
  go(kSettled, -kHalf, -s.depth);
  at.slow_from = t;
  go(2 * kHalf / s.slow, kHalf, -s.depth);
  at.slow_to = t;
  go(0.1, kHalf, -s.depth);
  at.fast_from = t;
  go(2 * kHalf / s.fast, -kHalf, -s.depth);
  at.fast_to = t;
  return path;
}

double ratio(const std::vector<dvec3>& force, double from, double to) {
  double across = 0.0, normal = 1e-9;
  const double begin = from + 0.3 * (to - from);  // the bristle is loaded
  for (auto i = static_cast<std::size_t>(1000 * begin); i < static_cast<std::size_t>(1000 * to); ++i)
    across += std::hypot(force[i].x, force[i].z), normal += force[i].y;
  return across / normal;
}

// [1] R.m.s. of the normal force about its running mean, of its mean; and its zero crossings per metre or second.
struct Shaking {
  double size, crossings;
};
Shaking shaking(const std::vector<dvec3>& force, double from, double to, double way) {
  const auto begin = static_cast<std::size_t>(1000 * from), end = static_cast<std::size_t>(1000 * to);
  double squares = 0.0, mean = 1e-9, crossings = 0.0, last = 0.0;
  constexpr std::size_t kHalfWindow = 25;
  for (std::size_t i = begin + kHalfWindow; i + kHalfWindow < end; ++i) {
    double around = 0.0;
    for (std::size_t j = i - kHalfWindow; j <= i + kHalfWindow; ++j) around += force[j].y / (2 * kHalfWindow + 1);
    const double fast = force[i].y - around;
    squares += fast * fast;
    mean += around;
    crossings += fast * last < 0;
    last = fast;
  }
  const double count = static_cast<double>(end - begin - 2 * kHalfWindow);
  return {std::sqrt(squares / count) / (mean / count), crossings / way};
}

std::vector<Features> feel_all(const Scene& scene, const Stroke& stroke) {
  auto opened = Session::open(scene);
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message());
  Session session = std::move(opened).value();
  Phases at{};
  for (std::size_t p = 0; p < kPlates; ++p)
    EXPECT_TRUE(session.follow(std::string("finger_") + kPlateNames[p], path_of(stroke, p, at)));
  std::vector<std::vector<dvec3>> force(kPlates);
  while (session.time() < at.fast_to) {
    EXPECT_TRUE(session.step(1));
    for (std::size_t p = 0; p < kPlates; ++p)
      force[p].push_back(session.reading(std::string("finger_") + kPlateNames[p])->force);
  }
  std::vector<Features> out;
  for (const std::vector<dvec3>& f : force) {
    const Shaking rough = shaking(f, at.fast_from, at.fast_to, 2 * kHalf);
    const Shaking struck = shaking(f, at.touches + stroke.depth / stroke.strike, at.slow_from, kSettled);
    out.push_back({ratio(f, at.slow_from, at.slow_to), ratio(f, at.fast_from, at.fast_to), std::log(rough.size + 1e-3),
                   std::log(rough.crossings + 10), std::log(struck.size + 1e-3)});
  }
  return out;
}

TEST(EffectsLevel, ItsSixPlatesAreDistinguishedBlind) {
  const auto scene = load_scene(PLIANT_SOURCE_DIR "/content/levels/effects.glb");
  ASSERT_TRUE(scene) << scene.error().message();
  std::mt19937 random(17);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto any_stroke = [&] {
    return Stroke{within(0.0012, 0.002), within(0.03, 0.06), within(0.01, 0.02), within(0.06, 0.1), within(-0.6, 0.6)};
  };
  constexpr int kLearnt = 5, kTried = 8;
  std::vector<std::vector<Features>> learnt(kPlates);
  for (int n = 0; n < kLearnt; ++n) {
    const std::vector<Features> felt = feel_all(*scene, any_stroke());
    for (std::size_t p = 0; p < kPlates; ++p) learnt[p].push_back(felt[p]);
  }
  // Means, and one scatter per feature: within plates, with a floor of a tenth of the scatter between them.
  std::vector<Features> mean(kPlates, Features{});
  Features all{}, between{}, inside{};
  for (std::size_t f = 0; f < kFeatures; ++f) {
    for (std::size_t p = 0; p < kPlates; ++p) {
      for (const Features& each : learnt[p]) mean[p][f] += each[f] / kLearnt;
      all[f] += mean[p][f] / kPlates;
    }
    for (std::size_t p = 0; p < kPlates; ++p) {
      between[f] += (mean[p][f] - all[f]) * (mean[p][f] - all[f]) / kPlates;
      for (const Features& each : learnt[p])
        inside[f] += (each[f] - mean[p][f]) * (each[f] - mean[p][f]) / (kPlates * kLearnt);
    }
    inside[f] = std::max(inside[f], 0.01 * between[f]);
  }
  const auto distance = [&](const Features& felt, std::size_t plate) {
    double sum = 0.0;
    for (std::size_t f = 0; f < kFeatures; ++f)
      sum += (felt[f] - mean[plate][f]) * (felt[f] - mean[plate][f]) / inside[f];
    return std::sqrt(sum);
  };
  double narrowest = 1e30;
  std::string hardest;
  for (int n = 0; n < kTried; ++n) {
    const std::vector<Features> felt = feel_all(*scene, any_stroke());
    for (std::size_t p = 0; p < kPlates; ++p) {
      double nearest_other = 1e30;
      for (std::size_t q = 0; q < kPlates; ++q)
        if (q != p) nearest_other = std::min(nearest_other, distance(felt[p], q));
      EXPECT_LT(distance(felt[p], p), nearest_other) << kPlateNames[p] << " in stroke " << n;
      if (nearest_other / distance(felt[p], p) < narrowest)
        narrowest = nearest_other / distance(felt[p], p), hardest = kPlateNames[p];
    }
  }
  std::cout
      << "[   means  ] friction slow, fast, log of roughness, of crossings, of the knock; next over own distance: "
      << narrowest << " (" << hardest << ")\n";
  for (std::size_t p = 0; p < kPlates; ++p) {
    std::cout << "[          ] " << kPlateNames[p];
    for (const double value : mean[p]) std::cout << ' ' << value;
    std::cout << '\n';
  }
}

}  // namespace
}  // namespace pliant
