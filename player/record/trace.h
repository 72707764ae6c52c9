// A probe's history for a plot, in bounded memory for any length of run: columns of equal time, each with the minimum
// and maximum in it. When the columns are used up, neighbours are merged in pairs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "systems/device/reading.h"

namespace pliant {

struct Extremes {
  float min = std::numeric_limits<float>::max(), max = std::numeric_limits<float>::lowest();
  void add(double value) {
    min = std::min(min, static_cast<float>(value));
    max = std::max(max, static_cast<float>(value));
  }
  void add(const Extremes& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

struct TraceColumn {
  Extremes depth;               // [m]
  Extremes normal, tangential;  // [N]
  std::uint32_t ticks = 0;      // 0: no ticks in this column (an overrun)
  bool contact = false;
  std::uint8_t limited = 0;  // 1 << SafetyLimit: limits that acted in any of its ticks
};

class Trace {
 public:
  static constexpr std::size_t kColumns = 2048;

  void add(std::uint64_t tick, const ProbeReading& reading, std::uint8_t limited = 0) {
    while ((tick >> shift_) >= kColumns) halve();
    columns_.resize(std::max<std::size_t>(columns_.size(), (tick >> shift_) + 1));
    TraceColumn& column = columns_[tick >> shift_];
    column.depth.add(reading.depth);
    column.normal.add(reading.normal_force);
    column.tangential.add(reading.tangential_force);
    column.contact = column.contact || reading.in_contact;
    column.limited = static_cast<std::uint8_t>(column.limited | limited);
    ++column.ticks;
  }

  const std::vector<TraceColumn>& columns() const { return columns_; }
  double ticks_per_column() const { return static_cast<double>(std::uint64_t{1} << shift_); }

 private:
  void halve() {
    ++shift_;
    for (std::size_t i = 0; 2 * i < columns_.size(); ++i) {
      TraceColumn merged = columns_[2 * i];
      if (2 * i + 1 < columns_.size()) {
        const TraceColumn& other = columns_[2 * i + 1];
        merged.depth.add(other.depth);
        merged.normal.add(other.normal);
        merged.tangential.add(other.tangential);
        merged.ticks += other.ticks;
        merged.contact = merged.contact || other.contact;
        merged.limited = static_cast<std::uint8_t>(merged.limited | other.limited);
      }
      columns_[i] = merged;
    }
    columns_.resize((columns_.size() + 1) / 2);
  }

  std::vector<TraceColumn> columns_;
  unsigned shift_ = 0;  // log2 of the ticks in a column
};

}  // namespace pliant
