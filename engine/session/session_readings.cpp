// Readings of every tick (Session::keep_readings): the touch clock fills one ring per effector and never waits; the
// owner empties it.
#include <fmt/format.h>

#include "content/files/limits.h"
#include "engine/session/session_run.h"

namespace pliant {

void SessionRun::size_kept() {
  kept.clear();
  lost_reported.assign(effectors.size(), 0);
  for (std::size_t i = 0; keeps > 0 && i < effectors.size(); ++i)
    kept.push_back(std::make_unique<Recorder<EffectorRow>>(keeps));
}

Status Session::keep_readings(std::size_t ticks) {
  SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::keep_readings"); !s) return s;
  const std::size_t most_ticks =
      most(limits::kJournal) / (sizeof(EffectorRow) * std::max<std::size_t>(1, p.effectors.size()));
  if (ticks > most_ticks)
    return Error{"Session::keep_readings", fmt::format("{} ticks would take too much memory", ticks),
                 fmt::format("keep {} at most, and take them more often", most_ticks)};
  p.keeps = ticks;
  p.size_kept();
  return Done{};
}

Result<std::uint64_t> Session::take_readings(const std::string& name, std::vector<Reading>& out) {
  SessionRun& p = *run_;
  out.clear();
  const SessionEffector* const effector = p.find_effector(name);
  if (!effector) return p.unknown_effector(name);
  if (p.keeps == 0) return Error{"Session::take_readings", "none are kept", "call Session::keep_readings() first"};
  const auto i = static_cast<std::size_t>(effector - p.effectors.data());
  std::vector<EffectorRow> rows;
  p.kept[i]->drain(rows);
  for (EffectorRow& row : rows) {
    p.name_contacts(row);
    out.push_back(row.reading);
  }
  const std::uint64_t lost = p.kept[i]->lost();
  return lost - std::exchange(p.lost_reported[i], lost);
}

std::uint64_t Session::take_events(std::vector<FeltEvent>& out) {
  SessionRun& p = *run_;
  out.clear();
  std::vector<TouchEvent> events;
  p.events->drain(events);
  for (const TouchEvent& event : events) out.push_back(named(p.world, event));
  const std::uint64_t lost = p.events->lost();
  return lost - std::exchange(p.events_lost, lost);
}

}  // namespace pliant
