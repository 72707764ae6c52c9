// The keeper of the journal: drains the rings into forces.csv, events.csv, the plot's traces, the figures of the report
// and, on request, a recording; with a soft clock also into bodies.csv.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/world.h"
#include "content/files/growing_file.h"
#include "engine/run/journal.h"
#include "engine/run/pose_recorder.h"
#include "lab/console/interrupt.h"
#include "player/record/approach.h"
#include "player/record/body_keeper.h"
#include "player/record/trace.h"

namespace pliant {

struct ProbeSummary {
  std::string name, source;
  std::uint64_t contact_ticks = 0;
  double max_depth = 0.0;         // [m]
  double max_force = 0.0;         // [N]
  double max_torque = 0.0;        // [N m] of a tool
  double net_work = 0.0;          // [J] done by force and torque on the hand: trapezoidal rule over the ticks
  Approach approach;              // of a probe, until first contact
  bool tool = false;              // a tool, not a probe
  std::uint64_t late_ticks = 0;   // of a tool: ticks in which its contacts were not solved within the budget
  std::uint64_t stale_ticks = 0;  // of a tool: ticks with a model older than kStaleSteps soft steps
};

class Keeper {
 public:
  // `csv`: output file. Names are copied from the world now.
  static Result<Keeper> create(const World& world, const std::vector<Entity>& probes,
                               const std::vector<std::string>& sources, const std::filesystem::path& csv);
  // Starts recording. The touch clock adds rows to the returned recorder, which is drained with the journal's.
  PoseRecorder& record_to(RecordingWriter writer);
  // `csv`: output file of the events.
  Status keep_events(const std::filesystem::path& csv);
  void keep_bodies(BodyKeeper bodies) { bodies_.emplace(std::move(bodies)); }

  // A file that can no longer be written (disk full) ends the run.
  void end_when_full(const Interrupt& interrupt) { interrupt_ = &interrupt; }

  void keep(Journal& journal);                                  // all pending rows
  const std::vector<TickRow>& latest() const { return rows_; }  // rows of the last keep()
  // Closes the files and the recording and returns the first error. A recording without a tick is not written.
  Status finish();
  std::uint64_t rows() const { return kept_; }                                    // of forces.csv
  bool recorded_nothing() const { return recorder_ && recorder_->ticks() == 0; }  // so far

  const std::vector<ProbeSummary>& summaries() const { return summaries_; }
  bool keeps_events() const { return events_csv_.has_value(); }
  const std::vector<FeltEvent>& events() const { return events_; }  // the first kMostReported
  std::uint64_t happened() const { return happened_; }              // number of all events
  const std::vector<Trace>& traces() const { return traces_; }      // of plotted rows: the first kMaxPlotRows

 private:
  Keeper() = default;
  void keep(const TickRow& row);
  void keep(const TouchEvent& event);
  const std::optional<Error>& failure() const;
  struct Last {
    bool any = false;   // a valid place has been seen
    double time = 0.0;  // [s]
    dvec3 position{0}, force{0}, torque{0};
    dquat rotation{1, 0, 0, 0};
  };
  std::optional<GrowingFile> csv_;  // always set
  const Interrupt* interrupt_ = nullptr;
  std::string line_;
  bool torque_ = false;  // forces.csv has torque columns
  std::vector<TickRow> rows_;
  static constexpr std::size_t kMostReported = 1000;
  const World* world_ = nullptr;
  std::optional<GrowingFile> events_csv_;
  std::vector<TouchEvent> pending_;
  std::vector<FeltEvent> events_;
  std::uint64_t happened_ = 0;
  std::uint64_t kept_ = 0;  // rows
  std::vector<ProbeSummary> summaries_;
  std::vector<Trace> traces_;
  std::vector<Last> last_;
  std::vector<TouchableBox> touchable_;
  std::vector<std::string> names_;    // of the probes, quoted for CSV
  std::vector<std::string> objects_;  // by entity index, quoted
  std::optional<BodyKeeper> bodies_;
  std::unique_ptr<PoseRecorder> recorder_;
};

}  // namespace pliant
