#include "player/run/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "components/soft_body.h"
#include "content/files/file_io.h"
#include "content/keys/enum_words.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "player/record/plot.h"
#include "player/run/tool_words.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson percentiles(const Histogram& histogram, double scale, bool with_p999) {
  OrderedJson json;
  json["p50"] = histogram.percentile_us(0.5) * scale;
  json["p99"] = histogram.percentile_us(0.99) * scale;
  if (with_p999) json["p999"] = histogram.percentile_us(0.999) * scale;
  json["max"] = histogram.max_us() * scale;
  return json;
}

double mean(std::uint64_t sum, std::uint64_t count) {
  return count ? static_cast<double>(sum) / static_cast<double>(count) : 0.0;
}

OrderedJson objects(const RunFigures& figures) {
  OrderedJson list = OrderedJson::array();
  for (const AwakeStats& stats : figures.journal.awake()) {
    const World& world = figures.world;
    const Mesh& mesh = world.meshes[world.registry.get<Deformable>(stats.object).mesh];
    const Name* name = world.registry.find<Name>(stats.object);
    list.push_back({{"name", name ? name->value : mesh.name},
                    {"vertices", mesh.vertex_count},
                    {"triangles", mesh.triangles.size()},
                    {"zones", mesh.zone_count()},
                    {"awake_vertices", {{"mean", mean(stats.sum, figures.journal.ticks())}, {"max", stats.max}}}});
  }
  return list;
}

OrderedJson events(const Keeper& keeper) {
  OrderedJson list = OrderedJson::array();
  for (const FeltEvent& event : keeper.events()) {
    OrderedJson json{{"event", word_of(event.kind)}, {"tick", event.tick},     {"time_s", event.time},
                     {"probe", event.probe},         {"object", event.object}, {"index", event.index}};
    if (!event.layer.empty()) json["layer"] = event.layer;
    json["position_m"] = {event.position.x, event.position.y, event.position.z};
    if (event.kind != FeltKind::kCrossed) json["value_N"] = event.value;
    list.push_back(std::move(json));
  }
  return list;
}

OrderedJson names(const World& world, const std::vector<Entity>& entities) {
  OrderedJson list = OrderedJson::array();
  for (const Entity entity : entities) {
    const Name* name = world.registry.find<Name>(entity);
    list.push_back(name ? name->value : std::string());
  }
  return list;
}

// Counts of the limits: clipped and withheld always, others if they acted.
OrderedJson limits(const SafetyTally& tally) {
  OrderedJson json;
  for (std::size_t i = 0; i < kSafetyLimits; ++i) {
    const auto limit = static_cast<SafetyLimit>(i);
    const LimitCount& count = tally.of(limit);
    if (count.ticks > 0 || limit == SafetyLimit::kClipped || limit == SafetyLimit::kWithheld)
      json[key_of(limit)] = {{"ticks", count.ticks}, {"largest_share", count.largest_share}};
  }
  return json;
}

// Members of tools only.
OrderedJson tool(const World& world, Entity entity, const ProbeSummary& summary) {
  return {{"tool_force", word_of(world.registry.get<Handle6>(entity).force)},
          {"max_torque_Nm", summary.max_torque},
          {"late_ticks", summary.late_ticks},
          {"stale_ticks", summary.stale_ticks}};
}

OrderedJson probes(const RunFigures& figures) {
  OrderedJson list = OrderedJson::array();
  for (std::size_t i = 0; i < figures.keeper.summaries().size(); ++i) {
    const ProbeSummary& probe = figures.keeper.summaries()[i];
    OrderedJson entry{{"name", probe.name},
                      {"source", probe.source},
                      {"contact_ticks", probe.contact_ticks},
                      {"max_depth_m", probe.max_depth},
                      {"max_force_N", probe.max_force},
                      {"net_work_J", probe.net_work},
                      {"touched", names(figures.world, figures.journal.touched(figures.journal.probes()[i]))}};
    if (probe.tool) entry.update(tool(figures.world, figures.journal.probes()[i], probe));
    const HandSafety safety = find_safety(figures.world, figures.journal.probes()[i]);
    if (safety.force) entry.update(limits(safety.force->tally));
    if (safety.torque) entry["torque"] = limits(safety.torque->tally);
    if (const std::optional<Miss>& miss = figures.misses[i]) entry["missed_by_m"] = miss->distance;
    list.push_back(std::move(entry));
  }
  return list;
}

// A key without a value is left out.
OrderedJson json_of(const Note& note) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [key, value] :
       {std::pair("code", &note.code), {"of", &note.of}, {"what", &note.what}, {"cure", &note.cure}})
    if (!value->empty()) json[key] = *value;
  return json;
}

// Results of each device, and reasons why one could not be used.
OrderedJson devices(const RunFigures& figures) {
  OrderedJson list = OrderedJson::array();
  for (const DeviceView& device : figures.devices.devices) {
    const DroppedFrames& d = device.report.dropped;
    list.push_back({{"probe", device.effector},
                    {"id", device.id},
                    {"name", device.name},
                    {"state", name_of(device.report.state)},
                    {"samples", device.report.figures.samples},
                    {"not_ready", d.not_ready},
                    {"lost", d.lost},
                    {"dropped",
                     {{"too_short", d.too_short},
                      {"unknown", d.unknown},
                      {"version", d.version},
                      {"checksum", d.checksum},
                      {"number", d.number},
                      {"rotation", d.rotation},
                      {"key", d.key},
                      {"foreign", d.foreign},
                      {"late", d.late}}}});
  }
  return list;
}

// Additional, not part of the documented format: the cost of each system.
OrderedJson systems(const Schedule<World>& schedule) {
  OrderedJson list = OrderedJson::array();
  for (std::size_t i = 0; i < schedule.systems().size(); ++i) {
    OrderedJson entry = percentiles(schedule.cost(i), 1.0, true);
    entry["name"] = schedule.systems()[i].name;
    list.push_back(std::move(entry));
  }
  return list;
}

OrderedJson pairs(const World& world, const Journal& journal) {
  OrderedJson list = OrderedJson::array();
  for (const PressedPair& pair : journal.pressed_pairs()) {
    const OrderedJson between = names(world, {pair.a, pair.b});
    list.push_back({{"a", between[0]}, {"b", between[1]}, {"max_force_N", pair.largest}, {"contact_s", pair.time}});
  }
  return list;
}

// Figures of the soft clock.
OrderedJson soft(const SoftClock& clock, const World& world, const Journal& journal) {
  const SoftTally& tally = world.soft->tally;
  const SoftFigures& figures = clock.figures();
  OrderedJson json;
  json["step_ms"] = percentiles(clock.schedule().total(), 1e-3, false);
  json["steps"] = figures.steps;
  json["overruns"] = figures.overruns;
  json["tetrahedra"] = clock.tetrahedra();
  json["contacts"] = {{"mean", mean(figures.contacts_sum, figures.steps)}, {"max", figures.contacts_max}};
  json["sweeps"] = mean(figures.sweeps_sum, figures.steps);
  json["residual"] = std::max(figures.residual_max, tally.residual);
  json["unconverged"] = tally.unconverged;
  json["pairs"] = pairs(world, journal);
  json["contacts_cut"] = tally.contacts_cut;
  json["halted"] = tally.halted;
  json["halted_s"] = tally.halted_for;
  json["deepest_m"] = tally.deepest;
  json["began_inside_m"] = tally.began_inside;
  json["time_lost_s"] = figures.time_lost;
  json["systems_us"] = systems(clock.schedule());
  return json;
}

}  // namespace

std::string report_json(const RunFigures& figures) {
  static const Histogram none;
  const FrameFigures* frames = figures.frames;
  OrderedJson json;
  json["pliant"] = PLIANT_VERSION;
  json["level"] = figures.world.name;
  json["mode"] = figures.mode;
  json["field"] = figures.field;
  json["rate_hz"] = figures.rate;
  json["ticks"] = figures.journal.ticks();
  json["ended"] = figures.ended;
  json["tick_us"] = percentiles(figures.schedule.total(), 1.0, true);
  json["overruns"] = figures.overruns;
  json["frame_ms"] = percentiles(frames ? frames->cost() : none, 1e-3, false);
  json["upload_bytes_per_frame"] = {{"mean", frames ? mean(frames->upload_bytes(), frames->count()) : 0.0},
                                    {"max", frames ? frames->upload_bytes_max() : 0}};
  json["objects"] = objects(figures);
  json["probes"] = probes(figures);
  if (!figures.devices.devices.empty()) json["devices"] = devices(figures);
  if (figures.soft) json["soft"] = soft(*figures.soft, figures.world, figures.journal);
  if (figures.keeper.keeps_events()) {
    json["events"] = events(figures.keeper);
    json["events_total"] = figures.keeper.happened();
  }
  json["notes"] = OrderedJson::array();
  for (const Note& note : figures.notes) json["notes"].push_back(json_of(note));
  json["hash"] = figures.hash;
  json["systems_us"] = systems(figures.schedule);
  // Names come from files and may be invalid UTF-8.
  return json.dump(2, ' ', true, OrderedJson::error_handler_t::replace) + "\n";
}

std::optional<Error> write_reports(const RunFigures& figures, OutputFolder& out) {
  std::optional<Error> wrong;
  const auto note_first = [&](const Status& status) {
    if (!status && !wrong) wrong = out.at_place(status.error());
  };
  out.free_reserve();
  try {
    const std::string json = report_json(figures);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(json.data());
    note_first(write_file(out.stage("report.json"), std::span(bytes, json.size())));
    std::vector<PlotRow> rows;
    for (std::size_t i = 0; i < figures.keeper.summaries().size(); ++i)
      rows.push_back({figures.keeper.summaries()[i].name, figures.keeper.summaries()[i].source,
                      i < figures.keeper.traces().size() ? &figures.keeper.traces()[i] : nullptr,
                      figures.keeper.summaries()[i].tool});
    const double dt = 1.0 / figures.rate;
    const double seconds = static_cast<double>(figures.journal.ticks() + figures.overruns) * dt;
    note_first(plot_forces(out.stage("forces.png"), figures.world.name, rows, dt, seconds));
  } catch (const std::exception& error) {
    note_first(explain(error));
  }
  note_first(out.commit());
  return wrong;
}

void print_summary(const RunFigures& figures, const OutputFolder& out) {
  const Histogram& tick = figures.schedule.total();
  print("{}: {} ticks at {} Hz in {}, tick {:.1f} us median, {:.1f} us p99, {} overruns, hash {}\n", figures.world.name,
        figures.journal.ticks(), figures.rate, figures.mode, tick.percentile_us(0.5), tick.percentile_us(0.99),
        figures.overruns, figures.hash);
  for (const ProbeSummary& probe : figures.keeper.summaries())
    print("  {} ({}): in contact for {:.2f} s, at most {:.2f} mm {} and {:.2f} N{}, net work {:.3g} mJ\n", probe.name,
          probe.source, static_cast<double>(probe.contact_ticks) / figures.rate, probe.max_depth * 1e3,
          probe.tool ? "device-handle offset" : "deep", probe.max_force,
          probe.tool ? fmt::format(" and {:.3f} N m", probe.max_torque) : std::string(), probe.net_work * 1e3);
  constexpr std::size_t kMostPrinted = 12;
  for (std::size_t i = 0; i < std::min(figures.keeper.events().size(), kMostPrinted); ++i)
    print("  {}\n", figures.keeper.events()[i].sentence());
  if (figures.keeper.happened() > kMostPrinted)
    print("  and {} more events: events.csv\n", figures.keeper.happened() - kMostPrinted);
  if (figures.soft) {
    const SoftFigures& soft = figures.soft->figures();
    const Histogram& step = figures.soft->schedule().total();
    print(
        "  soft: {} steps over {} tetrahedra, {:.2f} ms median, {:.2f} ms p99, {} overruns, {:.1f} contacts, at most "
        "{:.2f} mm into each other\n",
        soft.steps, figures.soft->tetrahedra(), step.percentile_us(0.5) * 1e-3, step.percentile_us(0.99) * 1e-3,
        soft.overruns, mean(soft.contacts_sum, soft.steps), figures.world.soft->tally.deepest * 1e3);
  }
  std::string files;
  for (const std::string& name : out.written())
    if (!name.starts_with("frame-")) files += (files.empty() ? "" : ", ") + name;
  if (figures.pictures > 0)
    files +=
        fmt::format("{}{} picture{}", files.empty() ? "" : ", ", figures.pictures, figures.pictures == 1 ? "" : "s");
  print("{}: {}{}\n", out.shown().string(), files.empty() ? "nothing could be written" : files,
        out.moved()
            ? fmt::format(" ({} has results already, which stay; --force replaces a run's)", out.asked().string())
            : std::string());
}

}  // namespace pliant
