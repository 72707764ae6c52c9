// pliant fit: which of the three kinds is meant.
#include "player/fit/fit.h"

#include <algorithm>
#include <filesystem>

#include "player/exit.h"

namespace pliant {
namespace {

bool is_measured(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".csv" || extension == ".tsv" || extension == ".txt";
}

}  // namespace

int fit(const FitOptions& options) {
  if (!options.sweep.empty()) {
    if (!options.in.empty())
      return fail(kUsage, {"fit " + options.in, "stands beside --sweep; name what was measured with --target"});
    return fit_sweep(options);
  }
  if (!options.target.empty()) return fail(kUsage, {"--target", "is for --sweep DIR; without it, name the file first"});
  if (options.in.empty())
    return fail(kUsage, {"fit",
                         "say what: a level with --object, measured presses (.csv), or --sweep DIR --target CSV; "
                         "see `pliant fit --help`"});
  return is_measured(options.in) ? fit_press(options) : fit_tissue(options);
}

}  // namespace pliant
