#include "lab/fit/surface_check.h"

#include <algorithm>

#include "pliant/session.h"

namespace pliant {
namespace {

constexpr int kCheckParts = 10;  // ticks in which a depth is reached, so that the contact point follows the probe
constexpr int kRecover = 400;    // [ticks] until the last dent has recovered
constexpr double kAbove = 1.0;   // [deepest press] height at which a probe waits

MeshData data_of(const std::vector<Primitive>& primitives) {
  MeshData out;
  for (const Primitive& p : primitives) {
    const auto first = static_cast<std::uint32_t>(out.position.size());
    out.position.insert(out.position.end(), p.position.begin(), p.position.end());
    for (const std::uint32_t i : p.index) out.index.push_back(first + i);
    out.stiffness.resize(first, 1.0f);
    out.stiffness.insert(out.stiffness.end(), p.stiffness.begin(), p.stiffness.end());
    out.stiffness.resize(out.position.size(), 1.0f);
    out.normal.resize(first, vec3(0));
    out.normal.insert(out.normal.end(), p.normal.begin(), p.normal.end());
    if (p.normal.size() != p.position.size()) out.normal.clear();
  }
  return out;
}

}  // namespace

Result<std::vector<std::vector<PressedTissue>>> press_surface(const std::vector<Primitive>& primitives,
                                                              const DeformableParameters& surface, const Mesh& built,
                                                              const std::vector<PressedPlace>& places) {
  Scene scene;
  DeformableParameters smooth = surface;
  smooth.friction_static = smooth.friction_sliding = smooth.friction_viscous = 0.0;
  smooth.texture_amplitude = smooth.transient_amplitude = smooth.relief = 0.0;
  scene.add_surface("surface", data_of(primitives), smooth);
  DeviceParameters device;
  device.max_force = 1e3;
  // Each place has its own probe: a single one would pass through the object on its way.
  const auto name = [](std::size_t i) { return "probe " + std::to_string(i); };
  const auto at_depth = [&](std::size_t i, double depth) {
    return places[i].place.position - depth * places[i].place.normal;
  };
  const auto above = [&](std::size_t i) {
    return places[i].presses.empty() ? 0.0 : kAbove * places[i].presses.back().depth;
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!places[i].presses.empty()) scene.add_probe(name(i), {}, device, {at_depth(i, -above(i))});
  Result<Session> session = Session::open(scene);
  if (!session) return session.error();
  std::vector<std::vector<PressedTissue>> out(places.size());
  std::vector<vec4> stream;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].presses.empty()) continue;
    const auto to = [&](double depth) { return session->move(name(i), at_depth(i, depth)); };
    Status done = session->step(kRecover);
    double at = -above(i);
    for (const PressedTissue& press : places[i].presses) {
      const double depth = press.depth;
      for (int k = 1; k <= kCheckParts && done; ++k) {
        done = to(at + (depth - at) * k / kCheckParts);
        if (done) done = session->step();
      }
      at = depth;
      if (done) done = session->step(3);
      if (!done) return done.error();
      const Result<Reading> reading = session->reading(name(i));
      if (!reading) return reading.error();
      dvec3 force(0);
      for (std::uint32_t c = 0; c < reading->contacts; ++c) force += reading->contact[c].force;
      PressedTissue& state = out[i].emplace_back();
      state.depth = depth;
      state.force = dot(force, places[i].place.normal);
      if (const Status streamed = session->stream("surface", stream); !streamed) return streamed.error();
      for (const PlacedSample& seen : places[i].seen) {
        const uvec3 t = built.triangles[seen.triangle];
        double& height = state.height.emplace_back(0.0);
        for (int c = 0; c < 3; ++c) height += seen.barycentric[c] * static_cast<double>(stream[t[c]].w);
      }
    }
    if (done) done = to(-above(i));
    if (!done) return done.error();
  }
  return out;
}

}  // namespace pliant
