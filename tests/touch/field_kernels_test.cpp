// The vectorised zone kernels, against the same computation one vertex at a time.
#include "systems/touch/model/field_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/nonlinear_step.h"
#include "systems/touch/model/shape.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(FieldKernels, TargetsOfAZoneAreThoseOfItsVerticesForEveryShape) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sphere(24, 0.1), {}));
  for (const Shape shape : kEveryShape) {
    for (const float reach : {0.02f, 0.05f, 0.3f}) {
      for (const float parameter : {0.01f, 0.2f, 5.0f}) {
        FieldSource source;
        source.center = mesh.position(40) + vec3(1e-4f, 0, 2e-4f);
        source.normal = mesh.normal(40);
        source.amplitude = 0.004f;
        source.inv_reach2 = 1 / (reach * reach);
        source.shape = shape;
        const bool is_length = row_of(shape).parameter == ShapeParameter::kContactLength;
        source.parameter = is_length ? parameter * reach : parameter;
        float height = 0, normal = 0, steepest = source.amplitude / reach;
        for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) {
          ZoneTargets targets;
          targets.h.fill(7.0f);  // previous content does not matter
          add_targets(mesh, zone, source, true, targets);
          for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
            const std::uint32_t i = v - mesh.zone_begin(zone);
            const vec4 one = target_at(source, mesh.position(v), mesh.normal(v));
            height = std::max(height, std::abs(targets.h[i] - one.w));
            normal = std::max(normal, length(vec3(targets.nx[i], targets.ny[i], targets.nz[i]) - vec3(one)));
            steepest = std::max(steepest, length(vec3(one)));
          }
        }
        EXPECT_LE(height, 1e-6f * source.amplitude) << int(shape) << ' ' << reach << ' ' << parameter;
        EXPECT_LE(normal, 1e-6f * steepest) << int(shape) << ' ' << reach << ' ' << parameter;
      }
    }
  }
}

TEST(FieldKernels, VerticesBeyondTheReachAreLeftOutWithoutChangingABit) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sphere(24, 0.1), {}));
  const std::vector<ZoneBlocks> blocks = blocks_of(mesh);
  ASSERT_EQ(blocks.size(), mesh.zone_count());
  const auto bits = [](const auto& value) {
    std::array<char, sizeof value> out;
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  };
  for (const Shape shape : kEveryShape) {
    for (const float reach : {0.002f, 0.02f, 0.05f, 0.3f}) {
      FieldSource source;
      source.center = mesh.position(40) + vec3(1e-4f, 0, 2e-4f);
      source.normal = mesh.normal(40);
      source.amplitude = 0.004f;
      source.inv_reach2 = 1 / (reach * reach);
      source.shape = shape;
      source.parameter = row_of(shape).parameter == ShapeParameter::kContactLength ? 0.2f * reach : 0.2f;
      for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) {
        ZoneTargets all, some;
        some.h.fill(7.0f);  // previous content does not matter
        add_targets(mesh, zone, source, true, all);
        add_targets(mesh, zone, source, true, some, &blocks[zone]);
        ASSERT_EQ(bits(all), bits(some)) << int(shape) << ' ' << reach << ' ' << zone;
        source.center.x += 0.3f * reach;
        add_targets(mesh, zone, source, false, all);
        add_targets(mesh, zone, source, false, some, &blocks[zone]);
        source.center.x -= 0.3f * reach;
        ASSERT_EQ(bits(all), bits(some)) << int(shape) << ' ' << reach << ' ' << zone;
        VolumeSums of_all, of_some;
        add_volume_sums(mesh, zone, source, of_all);
        add_volume_sums(mesh, zone, source, of_some, &blocks[zone]);
        ASSERT_EQ(bits(of_all), bits(of_some)) << int(shape) << ' ' << reach << ' ' << zone;
      }
    }
  }
}

TEST(FieldKernels, TheSharedExponentialIsExactToSinglePrecision) {
  for (float x = 0; x > -80; x -= 0.00317f) {
    const double truth = std::exp(static_cast<double>(x));
    ASSERT_NEAR(shared::shape_exp(x), truth, 2.5e-7 * truth) << x;
  }
  EXPECT_EQ(shared::shape_exp(0.0f), 1.0f);
}

TEST(FieldKernels, PunchAndHertzMeetTheirClosedFormsOnBothSidesOfTheRimOfContact) {
  const double inner = 0.04;  // the window is one below u = 1/4
  for (double u = 0; u < 0.25; u += 0.0007) {
    const double rho = std::sqrt(u), a = std::sqrt(inner), r = std::min(1.0, a / std::max(rho, 1e-12));
    const double punch = u <= inner ? 1.0 : 2 / M_PI * std::asin(r);
    const double hertz =
        u <= inner ? 1 - 0.5 * u / inner : ((2 - u / inner) * std::asin(r) + std::sqrt(u / inner - 1)) / M_PI;
    EXPECT_NEAR(shared::shape_punch(float(u), float(inner)).x, punch, 1e-5 + (std::abs(u - inner) < 1e-6 ? 1e-2 : 0));
    EXPECT_NEAR(shared::shape_hertz(float(u), float(inner)).x, hertz, 1e-5);
  }
}

struct Zone {
  std::vector<vec4> state = std::vector<vec4>(kZoneSize, vec4(0)), rate = state;
};

Motion motion_of(SpringLaw law, double mass, double damping, double stiffening) {
  Motion m;
  m.mass = mass;
  m.damping = damping;
  m.law = {law, 1e5, stiffening};
  m.law.table = restoring_law(frictionless(SpringLaw::kTable)).table;
  return m;
}

// Every law with a passive step, stiffening and softening.
std::vector<std::pair<SpringLaw, double>> hardening_laws() {
  std::vector<std::pair<SpringLaw, double>> all;
  for (const SpringLaw law : kLaws)
    for (const double stiffening : {150.0, -80.0})
      if (row_of(law).step == SpringStep::kPassive) all.emplace_back(law, stiffening);
  return all;
}

TEST(FieldKernels, NonLinearStepsOfAZoneAreThoseOfItsVertices) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const auto& [law, hardening] : hardening_laws()) {
    for (const double mass : {1e-8, 4e-7, 1e-4, 1.0}) {  // from far too stiff for the step to nearly free
      for (const double damping : {0.0, 1e-3, 0.1}) {
        for (const float size : {1e-9f, 1e-5f, 0.004f, 0.05f}) {  // [m]
          for (const bool forced : {false, true}) {
            const Motion m = motion_of(law, mass, damping, hardening);
            Zone zone;
            ZoneTargets targets{};
            for (std::uint32_t i = 0; i < kZoneSize; ++i) {
              zone.state[i] = {0.1f * unit(random), 0.1f * unit(random), 0.1f * unit(random), size * unit(random)};
              zone.rate[i] = {unit(random), 0, unit(random), (i % 3 ? 1.0f : 100.0f) * size * unit(random) / 0.01f};
              targets.h[i] = forced ? size * unit(random) : 0.0f;
              targets.nx[i] = forced ? 0.1f * unit(random) : 0.0f;
            }
            const Zone start = zone;
            step_nonlinear(m, {}, 0, zone.state.data(), zone.rate.data(), nullptr, forced ? &targets : nullptr);
            for (std::uint32_t i = 0; i < kZoneSize; ++i) {
              const double h0 = static_cast<double>(start.state[i].w), v0 = static_cast<double>(start.rate[i].w);
              const double target = static_cast<double>(targets.h[i]);
              const double f = forced ? m.law.force(target) : 0.0;
              const HeightState one = step_restoring(m.law, {h0, v0}, mass, damping, 1.0, f, m.dt);
              const double d = std::abs(one.height - h0);
              ASSERT_NEAR(zone.state[i].w, one.height, 1e-7 * (std::abs(h0) + d))
                  << int(law) << " m " << mass << " b " << damping << " h0 " << h0 << " v0 " << v0;
              ASSERT_NEAR(zone.rate[i].w, one.velocity,
                          1e-7 * (std::abs(v0) + 2 * d / m.dt) + 1e-11 * std::abs(h0) / m.dt)
                  << int(law) << " m " << mass << " b " << damping << " h0 " << h0 << " v0 " << v0;
              // The normal correction: implicit midpoint with the slope at the middle.
              const double slope = m.law.slope(0.5 * (h0 + one.height)), m2 = 2 * mass / m.dt;
              const double pull = forced ? m.law.slope(target) * static_cast<double>(targets.nx[i]) : 0.0;
              const double s = static_cast<double>(start.state[i].x), r = static_cast<double>(start.rate[i].x);
              const double vm = (m2 * r - slope * s + pull) / (m2 + damping + 0.5 * m.dt * slope);
              ASSERT_NEAR(zone.state[i].x, s + m.dt * vm, 1e-7 * (std::abs(s) + std::abs(m.dt * vm)));
              ASSERT_NEAR(zone.rate[i].x, 2 * vm - r, 2e-7 * (std::abs(r) + 2 * std::abs(vm)));
            }
          }
        }
      }
    }
  }
}

TEST(FieldKernels, StepsOfAZoneThatRelaxesAreThoseOfItsVertices) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const SpringLaw law : kLaws) {
    if (row_of(law).step != SpringStep::kPassiveArm) continue;
    for (const double mass : {1e-8, 1e-4, 1.0})
      for (const double r1 : {0.2, 4.0})
        for (const bool forced : {false, true}) {
          Motion m = motion_of(law, mass, 1e-3, 150.0);
          m.arm_stiffness = r1;
          m.arm_half = 0.93;
          Zone zone, arms;
          ZoneTargets targets{};
          for (std::uint32_t i = 0; i < kZoneSize; ++i) {
            zone.state[i] = {0, 0, 0, 0.006f * unit(random)};
            zone.rate[i].w = 0.3f * unit(random);
            arms.state[i].w = 0.003f * unit(random);
            targets.h[i] = forced ? 0.004f * unit(random) : 0.0f;
          }
          const Zone start = zone, held = arms;
          step_nonlinear(m, {}, 0, zone.state.data(), zone.rate.data(), arms.state.data(), forced ? &targets : nullptr);
          for (std::uint32_t i = 0; i < kZoneSize; ++i) {
            const SolidState one = step_relaxing(m.law, {start.state[i].w, start.rate[i].w, held.state[i].w}, mass,
                                                 1e-3, r1, m.arm_half, forced ? m.law.force(targets.h[i]) : 0.0, m.dt);
            ASSERT_NEAR(zone.state[i].w, one.height, 2e-9) << int(law) << ' ' << mass;
            ASSERT_NEAR(zone.rate[i].w, one.velocity, 2e-6) << int(law) << ' ' << mass;
            ASSERT_NEAR(arms.state[i].w, one.arm, 1e-6 * (std::abs(one.arm) + 0.01)) << int(law) << ' ' << mass;
          }
        }
  }
}

// The normal correction is the gradient of the height: a tilted plane of heights keeps its tilt while it relaxes.
TEST(FieldKernels, TheNormalsOfAZoneThatRelaxesAreTheGradientOfItsHeights) {
  for (const SpringLaw law : kLaws) {
    if (row_of(law).step != SpringStep::kPassiveArm) continue;
    Motion m = motion_of(law, 1e-4, 1e-2, 150.0);
    m.arm_stiffness = 1.5;
    m.arm_half = 0.97;
    constexpr double kApart = 1e-5;  // [m] between two places whose heights differ by the tilt
    constexpr double kTilt = 0.2;
    SolidState low{-0.003, 0.0, 1.5 * m.law.force(-0.003)}, high{-0.003 + kTilt * kApart, 0.0, 0.0};
    high.arm = 1.5 * m.law.force(high.height);
    Zone zone, arms;
    zone.state[0] = {static_cast<float>(kTilt), 0, 0, -0.003f};
    arms.state[0] = {static_cast<float>(1.5 * m.law.slope(-0.003) * kTilt), 0, 0, static_cast<float>(low.arm)};
    for (int n = 0; n < 40; ++n) {
      step_nonlinear(m, {}, 0, zone.state.data(), zone.rate.data(), arms.state.data(), nullptr);
      for (SolidState* s : {&low, &high}) *s = step_relaxing(m.law, *s, m.mass, m.damping, 1.5, m.arm_half, 0.0, m.dt);
      ASSERT_NEAR(zone.state[0].x, (high.height - low.height) / kApart, 0.02 * kTilt) << int(law) << ' ' << n;
    }
  }
}

TEST(FieldKernels, ANonLinearZoneAtRestStaysAtRestToTheBit) {
  for (const auto& [law, hardening] : hardening_laws()) {
    Zone zone;
    zone.state[5].w = -0.003f;
    for (int n = 0; n < 10; ++n)
      step_nonlinear(motion_of(law, 1e-4, 1e-3, hardening), {}, 0, zone.state.data(), zone.rate.data(), nullptr,
                     nullptr);
    for (std::uint32_t i = 0; i < kZoneSize; ++i) {
      if (i == 5) continue;
      EXPECT_EQ(zone.state[i], vec4(0));
      EXPECT_EQ(zone.rate[i], vec4(0));
    }
    EXPECT_NE(zone.state[5].w, 0.0f);
  }
}

TEST(FieldKernels, UndampedNonLinearZonesKeepTheirEnergyAndDampedOnesOnlyLose) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const auto& [law, hardening] : hardening_laws()) {
    for (const double damping : {0.0, 1e-3}) {
      const Motion m = motion_of(law, 1e-4, damping, hardening);
      Zone zone;
      for (std::uint32_t i = 0; i < kZoneSize; ++i) zone.state[i].w = 0.006f * unit(random);
      const auto energy = [&](std::uint32_t i) {
        const double v = static_cast<double>(zone.rate[i].w);
        return 0.5 * m.mass * v * v + m.law.potential(static_cast<double>(zone.state[i].w));
      };
      std::vector<double> first(kZoneSize);
      for (std::uint32_t i = 0; i < kZoneSize; ++i) first[i] = energy(i);
      for (int n = 0; n < 2000; ++n) step_nonlinear(m, {}, 0, zone.state.data(), zone.rate.data(), nullptr, nullptr);
      for (std::uint32_t i = 0; i < kZoneSize; ++i) {
        EXPECT_LE(energy(i), first[i] * 1.0002 + 1e-15);
        if (damping == 0) EXPECT_GE(energy(i), first[i] * 0.9998 - 1e-15);
      }
    }
  }
}

}  // namespace
}  // namespace pliant
