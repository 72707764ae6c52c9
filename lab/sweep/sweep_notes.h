// Summary of a sweep's notes. For each limit: the number of runs in which it acted and its worst value. Every other
// note once for all runs that have one of the same code and object. Axes that have no effect.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/table.h"

namespace pliant {

struct SweepLimit {
  std::string key, what, cure;  // "clipped", "the force was clipped", the remedy
  std::size_t runs = 0;         // number of runs in which it acted
  double worst = 0.0;           // in the worst run: a share [1] of the wanted value, ticks, metres, ...
  std::string figure;           // figure that `worst` is a value of
  std::size_t row = 0;          // index of that run
};

struct SweepNote {
  Note note;  // of the first run with it; other runs have other numbers
  std::size_t runs = 0;
  std::size_t row = 0;  // index of that run
};

struct SweepNotes {
  std::size_t done = 0, untouched = 0;
  std::vector<SweepLimit> limits;
  std::vector<SweepNote> notes;        // except those of the limits; the most frequent first
  std::vector<std::string> idle_axes;  // axes of steps without effect, where at least two runs can be compared
};

SweepNotes find_notes(const SweepTable& table);
// One sentence each. `whole`: all runs are done, so that an axis without effect is final.
std::vector<std::string> sentences_of(const SweepNotes& notes, const SweepTable& table, bool whole);
// Adds members to a merge's report.
void add_notes(const SweepNotes& notes, const SweepTable& table, PlanJson& report);

}  // namespace pliant
