#include "player/record/keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "components/name_of.h"
#include "engine/run/limits.h"
#include "lab/files/csv.h"
#include "player/record/plot.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr const char* kColumns =
    "tick,time_s,probe,x,y,z,in_contact,object,depth_m,height_m,nx,ny,nz,fx,fy,fz,fn,ft,objects";
constexpr const char* kTorqueColumns = ",tx,ty,tz";  // only if a hand can have torque

}  // namespace

Result<Keeper> Keeper::create(const World& world, const std::vector<Entity>& probes,
                              const std::vector<std::string>& sources, const std::filesystem::path& csv) {
  Keeper keeper;
  keeper.world_ = &world;
  auto file = GrowingFile::create(csv);
  if (!file) return file.error();
  keeper.csv_.emplace(std::move(file).value());
  keeper.torque_ = std::any_of(probes.begin(), probes.end(),
                               [&](Entity hand) { return find_safety(world, hand).torque != nullptr; });
  std::string header = kColumns;
  for (std::size_t i = 0; i < kSafetyLimits; ++i) header += std::string(",") + key_of(static_cast<SafetyLimit>(i));
  keeper.csv_->add(header + (keeper.torque_ ? kTorqueColumns : "") + '\n');
  for (std::size_t i = 0; i < probes.size(); ++i) {
    ProbeSummary summary;
    summary.name = name_of(world, probes[i]);
    summary.source = sources[i];
    summary.tool = !world.registry.has<Probe>(probes[i]);
    keeper.names_.push_back(csv_text(summary.name));
    keeper.summaries_.push_back(summary);
  }
  keeper.traces_.resize(std::min(probes.size(), kMaxPlotRows));
  keeper.last_.resize(probes.size());
  keeper.touchable_ = touchable_boxes(world);
  for (auto [object, deformable] : world.registry.view<Deformable>()) {
    if (object.index >= keeper.objects_.size()) keeper.objects_.resize(object.index + 1);
    keeper.objects_[object.index] = csv_text(name_of(world, object));
  }
  return keeper;
}

Status Keeper::keep_events(const std::filesystem::path& csv) {
  auto file = GrowingFile::create(csv);
  if (!file) return file.error();
  events_csv_.emplace(std::move(file).value());
  events_csv_->add("tick,time_s,event,probe,object,index,layer,x,y,z,value_n\n");
  return Done{};
}

void Keeper::keep(Journal& journal) {
  rows_.clear();
  journal.drain(rows_);
  for (const TickRow& row : rows_) keep(row);
  pending_.clear();
  journal.drain(pending_);
  for (const TouchEvent& event : pending_) keep(event);
  if (bodies_) bodies_->keep();
  if (recorder_) recorder_->drain();
  if (const std::optional<Error>& full = failure(); full && interrupt_) interrupt_->end(*full);
}

const std::optional<Error>& Keeper::failure() const {
  if (bodies_ && bodies_->failure()) return bodies_->failure();
  if (recorder_ && recorder_->failure()) return recorder_->failure();
  if (events_csv_ && events_csv_->failure()) return events_csv_->failure();
  return csv_->failure();
}

void Keeper::keep(const TouchEvent& event) {
  FeltEvent felt = named(*world_, event);
  if (events_csv_) {
    line_.clear();
    fmt::format_to(std::back_inserter(line_), "{},{:.9g},{},{},{},{},{}", felt.tick, felt.time, word_of(felt.kind),
                   csv_text(felt.probe), csv_text(felt.object), felt.index, csv_text(felt.layer));
    put(line_, felt.position);
    put(line_, felt.value);
    line_ += '\n';
    events_csv_->add(line_);
  }
  if (happened_++ < kMostReported) events_.push_back(std::move(felt));
}

void Keeper::keep(const TickRow& row) {
  ++kept_;
  const ProbeReading& r = row.reading;
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{},{:.9g},{}", row.tick, row.time, names_[row.probe]);
  put(line_, r.position);
  line_ += r.in_contact ? ",1," : ",0,";
  if (r.in_contact && r.object.index < objects_.size()) line_ += objects_[r.object.index];
  put(line_, r.depth);
  put(line_, r.height);
  put(line_, r.normal);
  put(line_, r.force);
  put(line_, r.normal_force);
  put(line_, r.tangential_force);
  put(line_, row.objects);
  for (std::size_t i = 0; i < kSafetyLimits; ++i) line_ += row.limited & bit(static_cast<SafetyLimit>(i)) ? ",1" : ",0";
  if (torque_) put(line_, row.torque);
  line_ += '\n';
  csv_->add(line_);

  ProbeSummary& summary = summaries_[row.probe];
  if (r.in_contact) {
    ++summary.contact_ticks;
    summary.max_depth = std::max(summary.max_depth, r.depth);
  }
  summary.max_force = std::max(summary.max_force, length(r.force));
  summary.max_torque = std::max(summary.max_torque, length(row.torque));
  summary.late_ticks += row.late;
  summary.stale_ticks += row.stale;
  Last& last = last_[row.probe];
  const bool placed = plausible_position(r.position);  // a lost device's pose is arbitrary
  // A jump was not made by the hand (systems/safety/safety.h).
  const bool jumped = length(r.position - last.position) > kFastestHand * (row.time - last.time) * (1 + 1e-9);
  if (last.any && placed && !jumped) {
    summary.net_work += 0.5 * dot(last.force + r.force, r.position - last.position);
    const dvec3 torque = last.torque + row.torque;  // of tools, and of probes with an arm of lever
    if (torque != dvec3(0))
      summary.net_work += 0.5 * dot(torque, vector_of(row.device_rotation * glm::conjugate(last.rotation)));
  }
  last = {placed, row.time, r.position, r.force, row.torque, row.device_rotation};

  if (placed && summary.contact_ticks == 0) summary.approach.add(r.position, touchable_);

  if (row.probe < traces_.size()) traces_[row.probe].add(row.tick, r, row.limited);
}

PoseRecorder& Keeper::record_to(RecordingWriter writer) {
  recorder_ = std::make_unique<PoseRecorder>(std::make_unique<RecordingWriter>(std::move(writer)), names_.size());
  return *recorder_;
}

Status Keeper::finish() {
  std::vector<Status> closed{csv_->close()};
  if (events_csv_) closed.push_back(events_csv_->close());
  if (bodies_) closed.push_back(bodies_->finish());
  if (recorded_nothing()) recorder_.reset();
  if (recorder_) closed.push_back(recorder_->finish());
  for (Status& status : closed)
    if (!status) return status;
  return Done{};
}

}  // namespace pliant
