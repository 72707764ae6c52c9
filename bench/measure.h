// What every benchmark needs: its arguments, times and their statistics, and a file for the result.
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
  bool on = false;  // the switch was given
  std::string out;  // "": nothing is written

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

// [ms] of the processor, so that what else runs on the machine counts little.
inline double processor_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The value that a share q [1] of all does not exceed; `values` is not empty.
inline double percentile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())))];
}
inline double median(std::vector<double> values) {
  return percentile(std::move(values), 0.5);
}

}  // namespace pliant
