// What a sweep's runs had to say, put together: in how many of them a limit acted and how far at the worst, every other
// note once for all runs that said it alike, and axes along which nothing changes.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/table.h"

namespace pliant {

struct SweepLimit {
  std::string key, what, cure;  // "clipped", "the force was clipped", what to do
  std::size_t runs = 0;         // in which it acted
  double worst = 0.0;           // of the run where it was worst: a share [1] of what was wanted, ticks, metres, ...
  std::string figure;           // of which that is
  std::size_t row = 0;          // that run's
};

struct SweepNote {
  std::string sentence;  // of the first run that said it; other runs say it with other numbers
  std::size_t runs = 0;
  std::size_t row = 0;  // that run's
};

struct SweepNotes {
  std::size_t done = 0, untouched = 0;
  std::vector<SweepLimit> limits;
  std::vector<SweepNote> notes;        // but what stands among the limits; the most frequent first
  std::vector<std::string> idle_axes;  // names of those of steps, where two runs at least tell
};

SweepNotes find_notes(const SweepTable& table);
// A sentence each. `whole`: no run is left, so that an axis is idle for good.
std::vector<std::string> sentences_of(const SweepNotes& notes, const SweepTable& table, bool whole);
// Members of a merge's report.
void add_notes(const SweepNotes& notes, const SweepTable& table, PlanJson& report);

}  // namespace pliant
