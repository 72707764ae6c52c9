// Shared by all benchmarks: arguments, statistics of times, and the result file.
#pragma once

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

// [--SWITCH] [--out FILE.json]
struct BenchArguments {
  bool on = false;  // the switch is set
  std::string out;  // "": no file

  BenchArguments(int argc, char** argv, std::string_view name_of_switch = "") {
    for (int i = 1; i < argc; ++i) {
      const std::string_view argument = argv[i];
      if (argument == name_of_switch) on = true;
      if (argument == "--out" && i + 1 < argc) out = argv[++i];
    }
  }
  void save(const std::string& json) const {
    if (!out.empty()) std::ofstream(out) << json;
  }
};

// [ms] CPU time, which other processes affect little.
inline double processor_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The quantile q [1] of `values`, which must not be empty.
inline double percentile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())))];
}
inline double median(std::vector<double> values) {
  return percentile(std::move(values), 0.5);
}

}  // namespace pliant
