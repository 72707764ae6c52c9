// Time of a touch tick on meshes of different sizes with the same number of awake vertices, with more, of the step with
// everything awake; error of the single-precision field against a double-precision reference. Also the time of many
// objects of which one is touched, and of many contacts on one object.
//   bench_touch_tick [--large] [--out FILE.json]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "content/mesh/mesh_build.h"
#include "runtime/clock.h"
#include "scenes/exact_distance.h"
#include "scenes/scenes.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/prepare/prepare.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::Stage;

struct Row {
  std::uint32_t vertices = 0, awake = 0;
  double p50 = 0, p99 = 0, max = 0;                     // [us]
  double bytes = 0;                                     // touch state per vertex
  double prepare_s = 0;                                 // weld, order, zones, tree, fields
  double error = 0;                                     // [1] of the amplitude, largest over awake vertices
  std::vector<std::pair<std::string, double>> systems;  // [us] median of each
};

std::vector<std::pair<std::string, double>> cost_of_systems(const Stage& stage) {
  std::vector<std::pair<std::string, double>> out;
  for (std::size_t i = 0; i < stage.schedule().systems().size(); ++i)
    out.emplace_back(stage.schedule().systems()[i].name, stage.schedule().cost(i).percentile_us(0.5));
  return out;
}

void print_systems(const std::vector<std::pair<std::string, double>>& systems) {
  std::string line = "  median of each system [us]:";
  for (const auto& [name, us] : systems)
    if (us >= 0.1) line += fmt::format(" {} {:.2f}", name, us);
  fmt::print("{}\n", line);
}

// The body under the probe: a sphere, or one with bumps as wide as the reach.
struct Body {
  double radius = 0.1, height = 0, wave = 0;  // [m] of the sphere and of the bumps; [1/m] wave number
  double at(dvec3 direction) const {
    const dvec3 x = wave * radius * direction;
    return radius + height * std::sin(x.x) * std::sin(x.y) * std::sin(x.z);
  }
  Primitive mesh(int n) const {
    Primitive p = scenes::sphere(n, radius);
    for (vec3& x : p.position) x = vec3(at(normalize(dvec3(x))) * normalize(dvec3(x)));
    if (height != 0) p.normal.clear();
    return p;
  }
};

// [m2] squares of the distances from a contact: of chords, of arcs on the sphere, of exact paths on bumps.
std::vector<double> distances2(const Mesh& mesh, const Contact& contact, const Deformable& d, const Body& body) {
  std::vector<double> out;
  if (d.distance == Distance::kSurface && body.height != 0) {
    out = ExactDistance(mesh).from(contact.triangle, contact.foot, d.reach);
    for (double& r : out) r *= r;
    return out;
  }
  const double radius = length(contact.foot);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double chord = length(dvec3(mesh.position(v)) - contact.foot);
    const double arc = 2 * radius * std::asin(std::min(1.0, chord / (2 * radius)));
    out.push_back(d.distance == Distance::kSurface ? arc * arc : chord * chord);
  }
  return out;
}

// The target of the volume-preserving shape in double precision, with its own sum for c.
double field_error(Stage& stage, Entity surface, Entity probe, const Body& body) {
  const Mesh& mesh = stage.mesh(surface);
  const Contact& contact = stage.contact(probe);
  const Deformable& d = stage.world.registry.get<Deformable>(surface);
  const std::vector<double> distance2 = distances2(mesh, contact, d, body);
  const auto facing = [&](std::uint32_t v) {
    return d.distance == Distance::kSurface ? 1.0
                                            : std::clamp(4 * dot(dvec3(mesh.normal(v)), contact.normal), 0.0, 1.0);
  };
  double S0 = 0, S1 = 0, Q0 = 0, Q1 = 0, Q2 = 0, bend = 0, spread = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 x = dvec3(mesh.position(v)) - contact.foot;
    const double r2 = distance2[v], u = r2 / (d.reach * d.reach);
    if (u >= 1) continue;
    const double w = std::pow(1 - u, 3) * facing(v), A = mesh.area[v];
    S0 += A * w, S1 += A * w * u, Q0 += A * w * w, Q1 += A * w * w * u, Q2 += A * w * w * u * u;
    bend += A * w * dot(dvec3(mesh.normal(v)) - contact.normal, x), spread += A * w * r2;
  }
  const double aH = -contact.height * bend / spread;
  double c = S0 / S1;
  for (int i = 0; i < 20; ++i)
    c -= (S0 - c * S1 - aH * (Q0 - 2 * c * Q1 + c * c * Q2)) / (-S1 + aH * (2 * Q1 - 2 * c * Q2));
  const auto f = [&](std::uint32_t v) {
    const double u = std::min(1.0, distance2[v] / (d.reach * d.reach));
    return std::pow(1 - u, 3) * (1 - c * u) * facing(v);
  };
  const uvec3 t = mesh.triangles[contact.triangle];
  const double amplitude = -contact.height / (contact.barycentric.x * f(t.x) + contact.barycentric.y * f(t.y) +
                                              contact.barycentric.z * f(t.z));
  double worst = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    worst = std::max(
        worst, std::abs(stage.field(surface).stream[v].w - stage.field(surface).residual[v].w + amplitude * f(v)));
  return worst / amplitude;
}

constexpr std::uint32_t kManyAwake = 24000;       // of which some 14,000 are reached
constexpr double kPace = 0.33, kSlowPace = 0.03;  // [1] edges per tick

Row measure(int n, std::uint32_t wanted_awake, Distance distance, double pace, bool bumps = false) {
  Row row;
  Stage stage;
  Deformable d;
  d.distance = distance;
  Body body;
  const double radius = body.radius;
  const std::uint32_t vertices = 6u * static_cast<std::uint32_t>(n) * static_cast<std::uint32_t>(n) + 2;
  // Zones extend beyond the disc, so the disc itself contains fewer than the wanted awake vertices.
  d.reach = 2 * radius * std::sqrt(0.36 * wanted_awake / vertices);
  if (bumps) body.height = 0.15 * d.reach, body.wave = 3.14159 / d.reach;
  const auto begin = std::chrono::steady_clock::now();
  const Entity surface = stage.add(body.mesh(n), d);
  const Entity probe = stage.add_probe({0, body.at({0, 1, 0}) + 0.001, 0});
  stage.prepare();
  row.prepare_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double depth = 0.1 * d.reach, edge = stage.mesh(surface).mean_edge;
  stage.tick();
  std::vector<double> times;
  double awake = 0;
  constexpr int kTicks = 20000;
  for (int i = 0; i < kTicks; ++i) {
    // Along a curve that reaches new places.
    const double a = pace * edge / radius * i, b = 0.3 * std::sin(0.37 * a);
    const dvec3 direction = normalize(dvec3(std::sin(a), std::cos(a), b));
    stage.place(probe, direction * (body.at(direction) - depth));
    for (auto [entity, device] : stage.world.registry.view<HapticDevice>()) device.sensed_at = stage.time();
    const std::uint64_t t0 = now_ns();
    stage.tick();
    times.push_back(static_cast<double>(now_ns() - t0) * 1e-3);
    awake += stage.field(surface).awake_vertices;
  }
  row.error = field_error(stage, surface, probe, body);
  times.erase(times.begin(), times.begin() + kTicks / 20);
  row.vertices = stage.mesh(surface).vertex_count;
  row.awake = static_cast<std::uint32_t>(awake / kTicks);
  row.p50 = percentile(times, 0.5);
  row.p99 = percentile(times, 0.99);
  row.max = percentile(times, 1);
  row.systems = cost_of_systems(stage);
  row.bytes = static_cast<double>(touch_bytes(stage.mesh(surface), stage.field(surface))) / row.vertices;
  return row;
}

struct AllAwake {
  std::uint32_t vertices = 0;
  double step_ms = 0, copy_ms = 0;  // median; the copy moves as many bytes as the step reads and writes
};

AllAwake measure_all_awake(int n) {
  Stage stage;
  Deformable d;
  d.reach = 0.01;
  const Entity surface = stage.add(scenes::sphere(n, 0.1), d);
  stage.prepare();
  HeightField& field = stage.field(surface);
  const Motion m = motion(d, 1e-3);
  const std::uint32_t zones = stage.mesh(surface).zone_count();
  for (vec4& r : field.residual) r = vec4(1e-3f);
  // A step reads residual and rate and writes residual, rate and stream: 5 x 16 bytes per vertex. An equivalent copy
  // reads 2.5 x 16 and writes 2.5 x 16.
  std::vector<char> from(field.residual.size() * 40, 1), to(from.size());
  AllAwake out;
  out.vertices = stage.mesh(surface).vertex_count;
  std::vector<double> step, copy;
  for (int i = 0; i < 60; ++i) {
    std::uint64_t t0 = now_ns();
    for (std::uint32_t zone = 0; zone < zones; ++zone) {
      const ZoneRest rest = step_residual(m, {}, field, zone);
      if (rest.height >= 0) compose_stream(field, zone, nullptr, true);
    }
    step.push_back(static_cast<double>(now_ns() - t0) * 1e-6);
    t0 = now_ns();
    std::memcpy(to.data(), from.data(), from.size());
    copy.push_back(static_cast<double>(now_ns() - t0) * 1e-6);
    from[static_cast<std::size_t>(i)] = to[static_cast<std::size_t>(i) + 1];
  }
  out.step_ms = median(std::move(step));
  out.copy_ms = median(std::move(copy));
  return out;
}

// Ticks in which `probes` press side by side into one sheet, or into the first of many balls.
struct Many {
  std::uint32_t objects = 1, contacts = 0, awake = 0;
  double p50 = 0, p99 = 0;                              // [us] the whole tick
  std::vector<std::pair<std::string, double>> systems;  // [us] median of each
};

Many measure_many(int objects, int probes, Deformable d = {}) {
  Stage stage;
  d.reach = 0.005;
  const Entity surface = stage.add(scenes::sheet(probes > 1 ? 160 : 40, 0.16), d);
  const int side = static_cast<int>(std::ceil(std::sqrt(objects)));
  for (int i = 1; i < objects; ++i)
    stage.add(scenes::sphere(2, 0.02), d, Pose{{0.2 + 0.05 * (i % side), 0.0, 0.05 * (i / side)}});
  std::vector<Entity> hands;
  const int row = static_cast<int>(std::ceil(std::sqrt(probes)));
  const auto place = [&](int i, double time) {  // 4 mm apart: neighbouring dents overlap
    return dvec3(0.004 * (i % row - 0.5 * row) + 0.01 * std::sin(time), -0.001, 0.004 * (i / row - 0.5 * row));
  };
  for (int i = 0; i < probes; ++i) hands.push_back(stage.add_probe(place(i, 0.0) + dvec3(0, 0.002, 0)));
  stage.prepare();
  stage.tick();
  Many out;
  out.objects = static_cast<std::uint32_t>(objects);
  std::vector<double> times;
  for (int t = 0; t < 6000; ++t) {
    for (int i = 0; i < probes; ++i) stage.place(hands[static_cast<std::size_t>(i)], place(i, 1e-3 * t));
    const std::uint64_t t0 = now_ns();
    stage.tick();
    if (t > 300) times.push_back(static_cast<double>(now_ns() - t0) * 1e-3);
  }
  for (const SourceState& source : stage.world.touch->objects[0].sources) out.contacts += source.tracked;
  out.awake = stage.field(surface).awake_vertices;
  out.systems = cost_of_systems(stage);
  out.p50 = percentile(times, 0.5);
  out.p99 = percentile(times, 0.99);
  return out;
}

// Rows of the JSON's list `tick`; the medians at 1e4 and 1e6 vertices.
std::string ticks_of_sizes(bool large, double& first, double& at_1e6) {
  fmt::print("One touch tick, probe sliding, ~2,000 awake vertices\n");
  fmt::print("{:>10} {:>7} {:>9} {:>9} {:>9} {:>10} {:>10} {:>12}\n", "vertices", "awake", "p50 us", "p99 us", "max us",
             "bytes/vtx", "ready s", "error/ampl.");
  std::vector<std::pair<int, std::uint32_t>> sizes{{41, 2000}, {130, 2000}, {409, 2000}, {409, kManyAwake}};
  if (large) sizes.push_back({1291, 2000});
  std::string json;
  for (const auto& [n, awake] : sizes) {
    const Row r = measure(n, awake, Distance::kChord, kPace);
    if (first == 0) first = r.p50;
    if (n == 409 && awake == 2000) at_1e6 = r.p50;
    fmt::print("{:>10} {:>7} {:>9.2f} {:>9.2f} {:>9.1f} {:>10.0f} {:>10.2f} {:>12.1e}\n", r.vertices, r.awake, r.p50,
               r.p99, r.max, r.bytes, r.prepare_s, r.error);
    print_systems(r.systems);
    json += fmt::format(
        "{}\n    {{\"vertices\": {}, \"awake\": {}, \"p50_us\": {:.3f}, \"p99_us\": {:.3f}, \"max_us\": {:.1f}, "
        "\"bytes_per_vertex\": {:.1f}, \"ready_s\": {:.3f}, \"error_of_amplitude\": {:.3e}}}",
        n == 41 ? "" : ",", r.vertices, r.awake, r.p50, r.p99, r.max, r.bytes, r.prepare_s, r.error);
  }
  return json;
}

std::string ticks_along_the_surface() {
  fmt::print(
      "\ndistance along the surface against the chord\n{:>8} {:>10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>8} {:>12} {:>7}\n",
      "body", "vertices", "pace", "distance", "p50 us", "p99 us", "max us", "ready s", "error/ampl.", "ratio");
  std::string json;
  const char* comma = "";
  for (const bool bumps : {false, true}) {
    for (const int n : {41, 130, 409}) {
      for (const double pace : {kSlowPace, kPace}) {
        double chord = 0;
        for (const Distance distance : {Distance::kChord, Distance::kSurface}) {
          const Row r = measure(n, 2000, distance, pace, bumps);
          const bool along = distance == Distance::kSurface;
          if (!along) chord = r.p50;
          const char *word = along ? "surface" : "chord", *body = bumps ? "bumps" : "sphere";
          fmt::print("{:>8} {:>10} {:>6} {:>9} {:>9.2f} {:>9.2f} {:>9.1f} {:>8.2f} {:>12.1e} {:>7.2f}\n", body,
                     r.vertices, pace, word, r.p50, r.p99, r.max, r.prepare_s, r.error, r.p50 / chord);
          json += fmt::format(
              "{}\n    {{\"body\": \"{}\", \"vertices\": {}, \"edges_per_tick\": {}, \"distance\": \"{}\", "
              "\"p50_us\": {:.3f}, \"p99_us\": {:.3f}, \"max_us\": {:.1f}, \"ready_s\": {:.3f}, "
              "\"error_of_amplitude\": {:.3e}}}",
              comma, body, r.vertices, pace, word, r.p50, r.p99, r.max, r.prepare_s, r.error);
          comma = ",";
        }
      }
    }
  }
  return json;
}

std::string ticks_of_many() {
  fmt::print("\n{:>8} {:>9} {:>7} {:>9} {:>9}\n", "objects", "contacts", "awake", "p50 us", "p99 us");
  std::string json;
  for (const auto& [objects, probes] : {std::pair{1, 1}, {40, 1}, {4000, 1}, {1, 8}, {1, 64}}) {
    const Many m = measure_many(objects, probes);
    fmt::print("{:>8} {:>9} {:>7} {:>9.2f} {:>9.2f}\n", m.objects, m.contacts, m.awake, m.p50, m.p99);
    print_systems(m.systems);
    json += fmt::format(
        "{}\n    {{\"objects\": {}, \"contacts\": {}, \"awake\": {}, \"p50_us\": {:.3f}, \"p99_us\": {:.3f}}}",
        objects == 1 && probes == 1 ? "" : ",", m.objects, m.contacts, m.awake, m.p50, m.p99);
  }
  return json;
}

std::string ticks_with_effects() {
  std::string json;
  fmt::print("\none contact on one object\n{:>10} {:>9} {:>9}\n", "effect", "p50 us", "p99 us");
  const auto with = [](auto change) {
    Deformable d;
    change(d);
    return d;
  };
  const std::pair<const char*, Deformable> effects[] = {
      {"none", {}},
      {"stribeck", with([](Deformable& d) { d.friction_stribeck = 0.05, d.friction_viscous = 0.5; })},
      {"texture", with([](Deformable& d) { d.texture_amplitude = 1e-5; })},
      {"transient", with([](Deformable& d) { d.transient_amplitude = 5.0, d.transient_decay = 1.0; })}};
  for (const auto& [name, d] : effects) {
    const Many m = measure_many(1, 1, d);
    fmt::print("{:>10} {:>9.2f} {:>9.2f}\n", name, m.p50, m.p99);
    print_systems(m.systems);
    json += fmt::format("{}\n    {{\"effect\": \"{}\", \"p50_us\": {:.3f}, \"p99_us\": {:.3f}}}",
                        &d == &effects[0].second ? "" : ",", name, m.p50, m.p99);
  }
  return json;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  const BenchArguments arguments(argc, argv, "--large");
  double first = 0, at_1e6 = 0;
  std::string json = "{\n  \"tick\": [" + ticks_of_sizes(arguments.on, first, at_1e6);
  json += "\n  ],\n  \"distance\": [" + ticks_along_the_surface();
  const AllAwake all = measure_all_awake(409);
  fmt::print(
      "\ntick at 1e6 / tick at 1e4: {:.2f}\nall awake, {} vertices: {:.2f} ms a step, {:.2f} ms a copy of the same "
      "bytes, ratio {:.2f}\n",
      at_1e6 / first, all.vertices, all.step_ms, all.copy_ms, all.step_ms / all.copy_ms);
  json += "\n  ],\n  \"many\": [" + ticks_of_many();
  json += "\n  ],\n  \"effects\": [" + ticks_with_effects();
  json += fmt::format(
      "\n  ],\n  \"ratio_1e6_to_1e4\": {:.3f},\n  \"all_awake\": {{\"vertices\": {}, \"step_ms\": {:.3f}, \"copy_ms\": "
      "{:.3f}, "
      "\"ratio\": {:.3f}}}\n}}\n",
      at_1e6 / first, all.vertices, all.step_ms, all.copy_ms, all.step_ms / all.copy_ms);
  arguments.save(json);
}
