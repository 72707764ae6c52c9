#include "editor/panels/trace_window.h"

#include <algorithm>

namespace pliant {

std::pair<std::size_t, std::size_t> samples_between(const PlayTrace& trace, double low, double high) {
  const auto first = std::lower_bound(trace.samples.begin(), trace.samples.end(), low,
                                      [](const PlaySample& s, double t) { return s.time < t; });
  const auto last =
      std::upper_bound(first, trace.samples.end(), high, [](double t, const PlaySample& s) { return t < s.time; });
  return {static_cast<std::size_t>(first - trace.samples.begin()),
          static_cast<std::size_t>(last - trace.samples.begin())};
}

double window_end(const Play& play) {
  double end = std::max(play.latest(), kPlotSeconds);
  if (play.on() && play.status().again && play.status().time < end - kPlotSeconds)
    end = std::max(kPlotSeconds, play.status().time + 0.5 * kPlotSeconds);
  return end;
}

}  // namespace pliant
