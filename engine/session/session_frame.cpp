// Output of a Session (pliant/session.h): readings, deformed vertices, forces on them, the stream.
#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "engine/run/limits.h"
#include "engine/session/session_run.h"
#include "systems/soft/soft_state.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/feed/touch_events.h"

namespace pliant {
namespace {

constexpr const char* kNoSurface = "is not deformable (it has no PLIANT_deformable); ask Session::vertices()";

}  // namespace

Result<Reading> Session::reading(const std::string& name) const {
  const SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  if (run_->clock()) run_->rows.acquire();
  EffectorRow row = run_->rows.read()[static_cast<std::size_t>(effector - run_->effectors.data())];
  run_->name_contacts(row);
  return row.reading;
}

SessionFigures Session::figures() const {
  const SessionRun& p = *run_;
  SessionFigures out;
  if (p.clock()) {
    const TouchFigures& newest = p.clock()->figures();
    out = {p.clock()->now() + 1, newest.p50, newest.p99, newest.max, newest.overruns, p.runner->soft().latest().steps};
  } else if (p.runner) {  // none after a failed restart
    const Histogram& cost = p.runner->schedule().total();
    out = {p.ticks,    cost.percentile_us(0.5),         cost.percentile_us(0.99), cost.max_us(),
           p.overruns, p.runner->soft().figures().steps};
  }
  return out;
}

Result<std::vector<Note>> Session::findings() const {
  const SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::findings"); !s) return s.error();
  std::vector<Note> notes = explain_dropped(p.world.dropped | (p.world.soft ? p.world.soft->dropped : 0));
  if (std::optional<Note> events = explain_events(p.world)) notes.push_back(*std::move(events));
  for (const SessionEffector& effector : p.effectors) {
    for (Note& note : explain_limits(p.world, effector.entity, effector.name)) notes.push_back(std::move(note));
    if (std::optional<Note> late = effector.link.late_note(effector.name)) notes.push_back(std::move(*late));
  }
  return notes;
}

// The touch clock stops publishing for a reader that does not come (publish_paced): what waits is then old, and its
// next snapshots are awaited, some 4 ms.
void SessionRun::look() {
  if (!clock()) return view.take_all(world, {ticks, 1.0 / world.simulation.touch_rate, time});
  constexpr auto kLongest = std::chrono::milliseconds(50);
  const std::uint64_t wanted = clock()->now();
  const auto lag = static_cast<std::uint64_t>(2.0 * world.simulation.touch_rate / kPublishRate) + 1;  // [ticks]
  view.take(world);
  if (view.tick() + lag >= wanted) return;
  const auto begin = std::chrono::steady_clock::now();
  while ((view.tick() < wanted || !view.complete()) && !clock()->paused() && !clock()->done() &&
         std::chrono::steady_clock::now() - begin < kLongest) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    view.take(world);
  }
}

Status Session::body_contacts(std::vector<BodyContact>& out) {
  SessionRun& p = *run_;
  p.look();
  out.clear();
  for (const ContactMark& mark : p.view.contacts())
    out.push_back({dvec3(mark.position), dvec3(mark.normal), dvec3(mark.force), mark.sliding,
                   static_cast<double>(mark.depth), p.side(mark.a), p.side(mark.b)});
  return Done{};
}

Status Session::handles(std::vector<HandleReading>& out) {
  SessionRun& p = *run_;
  p.look();
  out.clear();
  for (const HandleMark& mark : p.view.handles()) {
    const Name* name = p.world.registry.find<Name>(mark.tool);
    out.push_back({name ? name->value : std::string(), mark.pose.position, mark.pose.rotation, dvec3(mark.force),
                   dvec3(mark.torque)});
  }
  return Done{};
}

Status Session::vertices(const std::string& object, std::vector<vec3>& out) {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  p.look();
  p.place_vertices(*entity, false, out);
  return Done{};
}

Status Session::vertex_forces(const std::string& object, std::vector<vec3>& out) {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  if (p.clock()) p.rows.acquire();
  p.look();
  const Mesh& mesh = *collision_mesh_of(p.world, *entity);
  std::vector<vec3> on_vertex(mesh.vertex_count, vec3(0));
  std::vector<float> copies(mesh.vertex_count, 0.0f);
  for (const EffectorRow& row : p.rows.read())
    for (std::uint32_t i = 0; i < row.reading.contacts; ++i) {
      const ContactReading& contact = row.reading.contact[i];
      if (p.object_entities[contact.object] != *entity) continue;
      for (int k = 0; k < 3; ++k) on_vertex[row.vertices[i][k]] -= row.weights[i][k] * vec3(contact.force);
    }
  for (const ContactMark& contact : p.view.contacts())
    for (const auto& [side, sign] : {std::pair(&contact.a, 1.0f), std::pair(&contact.b, -1.0f)})
      for (int k = 0; side->entity == *entity && k < 3; ++k)
        on_vertex[mesh.triangles[side->triangle][k]] += sign * side->barycentric[k] * contact.force;
  for (const std::uint32_t v : mesh.of_source)
    if (v != kBorder) copies[v] += 1.0f;
  out.assign(mesh.of_source.size(), vec3(0));
  for (std::size_t i = 0; i < out.size(); ++i)
    if (const std::uint32_t v = mesh.of_source[i]; v != kBorder) out[i] = on_vertex[v] / copies[v];
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    if (copies[v] == 0.0f && on_vertex[v] != vec3(0)) p.share_out(object, mesh, v, on_vertex[v], out);
  return Done{};
}

void SessionRun::share_out(const std::string& object, const Mesh& mesh, std::uint32_t vertex, vec3 force,
                           std::vector<vec3>& out) {
  auto [place, is_new] = places[object].try_emplace(vertex);
  if (is_new) {
    std::vector<dvec3> source(mesh.of_source.size(), dvec3(std::numeric_limits<double>::max()));
    for (std::size_t i = 0; i < source.size(); ++i)
      if (mesh.of_source[i] != kBorder) source[i] = dvec3(mesh.position(mesh.of_source[i]));
    std::vector<uvec3> triangles;
    for (const LevelNode& node : scene.level().nodes)
      if (node.name == object && node.mesh >= 0)
        triangles = source_triangles(scene.level().meshes[static_cast<std::size_t>(node.mesh)]);
    std::erase_if(triangles, [&](const uvec3& t) {
      return std::max({t.x, t.y, t.z}) >= source.size() || mesh.of_source[t.x] == kBorder ||
             mesh.of_source[t.y] == kBorder || mesh.of_source[t.z] == kBorder;
    });
    place->second = nearest_source(source, triangles, dvec3(mesh.position(vertex)));
  }
  for (int k = 0; k < 3; ++k) out[place->second.vertices[k]] += static_cast<float>(place->second.weights[k]) * force;
}

Result<Geometry> Session::geometry(const std::string& object) const {
  const SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  if (!p.world.registry.has<Deformable>(*entity)) return run_->body_geometry(*entity, object);
  const Drawable* const drawable = p.world.registry.find<Drawable>(*entity);
  if (!drawable) return Error{"`" + object + "`", "is not drawn", "it has no mesh"};
  const Mesh& mesh = *collision_mesh_of(p.world, *entity);
  const DrawMesh& draw = p.world.draw_meshes[drawable->mesh];
  Geometry out;
  for (const DrawVertex& vertex : draw.vertices) {
    out.position.push_back(vertex.position);
    out.normal.push_back(mesh.normal(vertex.touch_vertex));
    out.shading_normal.push_back(vertex.normal);
    out.uv.push_back(vertex.uv);
    out.stream_vertex.push_back(vertex.touch_vertex);
  }
  out.index = draw.indices;
  return out;
}

Status Session::stream(const std::string& object, std::vector<vec4>& out) {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  p.look();
  const std::vector<vec4>* const stream = p.view.stream(*entity);
  if (!stream) return Error{"`" + object + "`", kNoSurface};
  out = *stream;
  return Done{};
}

Status Session::stream(const std::string& object, std::vector<vec4>& out, std::vector<StreamPart>& changed) {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  p.look();
  if (!p.view.take_changes(*entity, out, changed)) return Error{"`" + object + "`", kNoSurface};
  return Done{};
}

Result<mat4> Session::to_world(const std::string& object) {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  p.look();
  return p.view.to_world(p.world, *entity);
}

}  // namespace pliant
