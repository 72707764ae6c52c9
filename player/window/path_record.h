// The path of one probe or tool, recorded while a window runs: a script (content/level/script.h) to play again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/run/journal.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

class PathRecord {
 public:
  static constexpr double kEvery = 0.01;      // [s] between rows
  static constexpr double kLongest = 3600.0;  // [s]

  void begin(std::uint32_t probe);  // index in the journal
  bool on() const { return probe_.has_value(); }
  double seconds() const;  // recorded so far
  bool full() const { return seconds() >= kLongest; }
  void add(const TickRow& row);
  // Ends it. Writes a new file `path-001.csv` in this folder, and returns its place.
  Result<std::filesystem::path> save(const std::filesystem::path& folder, const std::string& name);

 private:
  std::optional<std::uint32_t> probe_;
  std::optional<double> from_;  // [s]
  Path path_;
};

}  // namespace pliant
