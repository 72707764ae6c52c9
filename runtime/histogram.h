// Histogram of durations, for percentiles: logarithmic buckets, 64 per octave (about 1 % apart), fixed memory, no
// allocation. The maximum is exact.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace pliant {

class Histogram {
 public:
  void add(std::uint64_t nanoseconds) {
    ++counts_[bucket(nanoseconds)];
    ++count_;
    if (nanoseconds > max_) max_ = nanoseconds;
  }
  std::uint64_t count() const { return count_; }
  double max_us() const { return static_cast<double>(max_) * 1e-3; }

  // The duration that a share q of all durations does not exceed. [us]
  double percentile_us(double q) const {
    if (count_ == 0) return 0.0;
    const double wanted = q * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::uint32_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (static_cast<double>(seen) >= wanted) {
        const double us = upper_edge(i) * 1e-3;
        return us < max_us() ? us : max_us();
      }
    }
    return max_us();
  }

 private:
  static constexpr std::uint32_t kPerOctave = 64, kOctaves = 40;
  static std::uint32_t bucket(std::uint64_t ns) {
    if (ns < kPerOctave) return static_cast<std::uint32_t>(ns);
    const std::uint32_t octave = static_cast<std::uint32_t>(std::bit_width(ns)) - 7;  // 64..127 is octave 0
    const std::uint32_t i = (octave + 1) * kPerOctave + static_cast<std::uint32_t>((ns >> octave) - kPerOctave);
    return i < kPerOctave * kOctaves ? i : kPerOctave * kOctaves - 1;
  }
  static double upper_edge(std::uint32_t i) {
    if (i < kPerOctave) return static_cast<double>(i);
    const std::uint32_t octave = i / kPerOctave - 1;
    return static_cast<double>((static_cast<std::uint64_t>(kPerOctave + i % kPerOctave + 1) << octave) - 1);
  }

  std::array<std::uint64_t, kPerOctave * kOctaves> counts_{};
  std::uint64_t count_ = 0, max_ = 0;
};

}  // namespace pliant
