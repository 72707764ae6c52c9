// The keeping half of the journal: takes rows off the ring and turns them into forces.csv, the plot's traces, the
// figures of the report and, if asked, a recording; with a soft clock, its rows into bodies.csv too.
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
#include "player/record/body_keeper.h"
#include "player/record/trace.h"
#include "player/run/approach.h"

namespace pliant {

struct ProbeSummary {
  std::string name, source;
  std::uint64_t contact_ticks = 0;
  double max_depth = 0.0;         // [m]
  double max_force = 0.0;         // [N]
  double max_torque = 0.0;        // [N m] of a tool
  double net_work = 0.0;          // [J] done by force and torque on the hand: trapezoidal over the ticks
  Approach approach;              // of a probe, until it touches
  bool tool = false;              // not a probe
  std::uint64_t late_ticks = 0;   // of a tool: its contacts were not solved within the tick's budget
  std::uint64_t stale_ticks = 0;  // of a tool: its model was older than kStaleSteps soft steps
};

class Keeper {
 public:
  // `csv` is where the rows go. Names are taken from the world now.
  static Result<Keeper> create(const World& world, const std::vector<Entity>& probes,
                               const std::vector<std::string>& sources, const std::filesystem::path& csv);
  // Rows of the touch clock come from it; it is drained with the journal's.
  PoseRecorder& record_to(RecordingWriter writer);
  void keep_bodies(BodyKeeper bodies) { bodies_.emplace(std::move(bodies)); }

  // A file that cannot be written any more, on a full disk, ends the run.
  void end_when_full(const Interrupt& interrupt) { interrupt_ = &interrupt; }

  void keep(Journal& journal);                                  // all rows that wait
  const std::vector<TickRow>& latest() const { return rows_; }  // what the last keep() took
  // Closes the files and the recording; the first error of any. A recording without a tick is not written.
  Status finish();
  std::uint64_t rows() const { return kept_; }                                    // of forces.csv
  bool recorded_nothing() const { return recorder_ && recorder_->ticks() == 0; }  // so far

  const std::vector<ProbeSummary>& summaries() const { return summaries_; }
  const std::vector<Trace>& traces() const { return traces_; }  // of those that are plotted: the first kMaxPlotRows

 private:
  Keeper() = default;
  void keep(const TickRow& row);
  const std::optional<Error>& failure() const;
  struct Last {
    bool any = false;   // with a place that means something
    double time = 0.0;  // [s]
    dvec3 position{0}, force{0}, torque{0};
    dquat rotation{1, 0, 0, 0};
  };
  std::optional<GrowingFile> csv_;  // always there
  const Interrupt* interrupt_ = nullptr;
  std::string line_;
  bool torque_ = false;  // forces.csv has its columns
  std::vector<TickRow> rows_;
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
