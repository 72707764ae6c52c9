// pliant fit: selects one of the three kinds of fit.
#include "lab/fit/fit.h"

#include <algorithm>
#include <filesystem>

#include "lab/console/exit.h"

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
  const bool measured = options.sweep.empty() && is_measured(options.in), elements = options.sweep.empty() && !measured;
  if (!measured && !options.of_measured.empty())
    return fail(kUsage, {options.of_measured[0], "is for measured presses (.csv)", "leave it out"});
  if (!elements && !options.of_elements.empty())
    return fail(kUsage, {options.of_elements[0], "is for finite elements of a level's object", "leave it out"});
  if (!options.sweep.empty()) {
    if (!options.in.empty())
      return fail(kUsage, {"fit " + options.in, "stands beside --sweep", "name what was measured with --target"});
    if (!options.out.empty() || !options.object.empty() || options.unit)
      return fail(kUsage, {"--sweep", "writes no level", "leave out -o, --object and --unit"});
    if (options.radius > 0.0 || options.poisson >= 0.0)
      return fail(kUsage, {options.radius > 0.0 ? "--radius" : "--poisson", "is of a law, and --sweep fits none",
                           "leave it out: the sweep's plan says it"});
    return fit_sweep(options);
  }
  if (!options.target.empty())
    return fail(kUsage, {"--target", "is for --sweep DIR", "without it, name the file first"});
  if (elements && !options.probe.empty())
    return fail(kUsage, {"--probe", "is for a run's forces.csv or a sweep", "give the indenter's --radius instead"});
  if (measured && options.level.empty() && !options.object.empty())
    return fail(kUsage, {"--object", "is a node of the level that --level names", "name that, too, or leave it out"});
  if (measured && options.law != "auto" && options.law != "hertz" && (options.radius > 0.0 || options.poisson >= 0.0))
    return fail(kUsage, {options.radius > 0.0 ? "--radius" : "--poisson",
                         "is of the law hertz, and --law asks for " + options.law, "leave one of them out"});
  if (measured && options.poisson >= 0.0 && !(options.radius > 0.0))
    return fail(kUsage, {"--poisson", "is of the law hertz, which needs a sphere", "give its --radius, too"});
  if (measured && options.level.empty() && options.unit)
    return fail(kUsage, {"--unit", "is of the bare mesh that --level names", "a table's units stand in its header"});
  if (options.in.empty())
    return fail(kUsage, {"fit", "say what: a level with --object, measured presses (.csv), or --sweep DIR --target CSV",
                         "see `pliant fit --help`"});
  return measured ? fit_press(options) : fit_tissue(options);
}

}  // namespace pliant
