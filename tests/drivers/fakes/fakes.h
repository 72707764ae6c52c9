// Interface between tests and the fake vendor libraries. Each library exports one of these through its function
// fake_dhd or fake_hd.
#pragma once

#include <atomic>

struct FakeDhd {
  std::atomic<int> devices{1}, type{33};
  std::atomic<bool> calibrated{true}, unplugged{false};
  std::atomic<bool> force_button{true};            // false: the device itself has switched the force off
  std::atomic<double> x{0}, y{0}, z{0};            // [m] the maker's axes
  std::atomic<double> fx{0}, fy{0}, fz{0}, tz{0};  // [N] [N m] set last
  std::atomic<double> largest{0};                  // [N] ever set
  std::atomic<int> exchanges{0}, stops{0}, opens{0}, closes{0};
  std::atomic<bool> open{false}, enabled{false};
};

struct FakeHd {
  std::atomic<bool> present{true};
  std::atomic<double> x{0}, y{0}, z{0};  // [mm]
  std::atomic<double> turn{0};           // [rad] about z
  std::atomic<int> buttons{0};
  std::atomic<double> fx{0}, fy{0}, fz{0};  // [N] of the last frame
  std::atomic<double> largest{0};           // [N]
  std::atomic<unsigned> next_fault{0};      // given once
  std::atomic<unsigned> calibration{0x5000};
  std::atomic<int> frames{0};
  std::atomic<bool> running{false}, initialised{false}, output{false}, clamp{false}, ramp{false}, limit{false};
};
