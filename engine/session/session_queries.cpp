// Geometry queries of a Session (pliant/query.h): triangles, the closest point, rays, bounds, and the place of a
// contact among an object's own triangles. On the owner's thread, from the state that the clocks have published.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/soft_body.h"
#include "engine/session/session_run.h"

namespace pliant {
namespace {

bool is_finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::optional<std::size_t> index_among(const std::vector<Entity>& all, Entity entity) {
  const auto found = std::find(all.begin(), all.end(), entity);
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

dvec3 outward_normal(const TriangleBoxes& boxes, std::uint32_t t) {
  const dvec3 area = cross(boxes.corner(t, 1) - boxes.corner(t, 0), boxes.corner(t, 2) - boxes.corner(t, 0));
  const double size = length(area);
  return size > 0.0 ? area / size : dvec3(0);
}

QueryHit hit_of(const TriangleBoxes& boxes, std::uint32_t object, const TrianglePlace& place) {
  QueryHit hit{object, place.triangle, place.weights, dvec3(0), outward_normal(boxes, place.triangle), place.distance};
  for (int k = 0; k < 3; ++k) hit.position += place.weights[k] * boxes.corner(place.triangle, k);
  return hit;
}

// The objects selected by the options.
Result<std::vector<std::size_t>> asked(const SessionRun& p, const QueryOptions& options, const char* what) {
  if (!(options.within >= 0.0)) return Error{what, "`within` is negative or no number", "give 0 m or more"};
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < p.objects.size(); ++i)
    if (options.object.empty() ? !p.taken_out[i] : p.objects[i] == options.object) out.push_back(i);
  if (!options.object.empty() && out.empty()) return p.find_object(options.object).error();
  return out;
}

const std::optional<TriangleBoxes>& boxes_of(SessionRun& p, std::size_t object, bool rest) {
  ObjectShape& shape = p.shape(object);
  ObjectShape::Placed& placed = rest ? shape.at_rest : shape.now;
  if (placed.version == p.view.version()) return placed.boxes;
  std::vector<vec3> vertices;
  p.place_vertices(p.object_entities[object], rest, vertices);
  std::vector<dvec3> positions(vertices.begin(), vertices.end());
  if (placed.boxes)
    placed.boxes->fit(std::move(positions));
  else
    placed.boxes.emplace(std::move(positions), shape.triangles(), shape.touched());
  placed.version = p.view.version();
  return placed.boxes;
}

}  // namespace

void SessionRun::see() {
  if (!clock() && looked == ticks + 1) return;
  look();
  looked = ticks + 1;
}

const LevelMesh* SessionRun::given_mesh(const std::string& object) const {
  for (const LevelNode& node : scene.level().nodes)
    if (node.name == object && node.mesh >= 0) return &scene.level().meshes[static_cast<std::size_t>(node.mesh)];
  return nullptr;
}

ObjectShape& SessionRun::shape(std::size_t object) {
  if (!shapes[object])
    shapes[object] =
        std::make_unique<ObjectShape>(*collision_mesh_of(world, object_entities[object]), given_mesh(objects[object]));
  return *shapes[object];
}

void SessionRun::place_vertices(Entity object, bool rest, std::vector<vec3>& out) const {
  const Mesh& mesh = *collision_mesh_of(world, object);
  const std::vector<vec4>* const stream = view.stream(object);
  const SoftObjectSnapshot* const moved = view.soft(object);
  const mat4 to_world = rest ? view.rest_to_world(world, object) : view.to_world(world, object);
  out.assign(mesh.of_source.size(), vec3(to_world[3]));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t v = mesh.of_source[i];
    if (v == kBorder) continue;  // used by no triangle
    if (!rest && moved && !moved->position.empty()) {
      out[i] = moved->position[v];
    } else {
      const float height = stream && !rest ? (*stream)[v].w : 0.0f;
      out[i] = vec3(to_world * vec4(mesh.position(v) + height * mesh.normal(v), 1.0f));
    }
  }
}

Geometry SessionRun::body_geometry(Entity entity, const std::string& object) {
  const Mesh& mesh = *collision_mesh_of(world, entity);
  const LevelMesh* const given = given_mesh(object);
  Geometry out;
  for (std::uint32_t i = 0; i < mesh.of_source.size(); ++i) {
    const std::uint32_t v = mesh.of_source[i];
    out.position.push_back(v == kBorder ? vec3(0) : mesh.position(v));
    out.normal.push_back(v == kBorder ? vec3(0) : mesh.normal(v));
    out.stream_vertex.push_back(i);
  }
  out.shading_normal = out.normal;
  out.uv.assign(out.position.size(), vec2(0));
  std::size_t first = 0;
  for (std::size_t k = 0; given && k < given->primitives.size(); ++k) {
    const Primitive& p = given->primitives[k];
    if (!p.uv.empty()) std::copy(p.uv.begin(), p.uv.end(), out.uv.begin() + static_cast<std::ptrdiff_t>(first));
    first += p.position.size();
  }
  for (const uvec3& t : shape(*index_among(object_entities, entity)).triangles())
    out.index.insert(out.index.end(), {t.x, t.y, t.z});
  return out;
}

ContactSide SessionRun::side(const ContactPlace& place) {
  ContactSide side;
  for (std::uint32_t i = 0; i < effectors.size(); ++i)
    if (effectors[i].entity == place.entity) side.effector = i;
  const std::optional<std::size_t> object = index_among(object_entities, place.entity);
  if (!object) return side;
  side.object = static_cast<std::uint32_t>(*object);
  const ObjectShape::Place at = shape(*object).place(place.triangle, dvec3(place.barycentric));
  side.triangle = at.triangle;
  side.vertex = at.vertex;
  return side;
}

void SessionRun::name_contacts(EffectorRow& row) {
  for (std::uint32_t i = 0; i < row.reading.contacts; ++i) {
    ContactReading& contact = row.reading.contact[i];
    if (contact.object >= shapes.size()) continue;
    const ObjectShape::Place at = shape(contact.object).place(row.vertices[i], dvec3(row.weights[i]));
    contact.triangle = at.triangle;
    contact.vertex = at.vertex;
  }
}

Status Session::triangles(const std::string& object, std::vector<std::uint32_t>& out) const {
  SessionRun& p = *run_;
  const auto entity = p.find_object(object);
  if (!entity) return entity.error();
  out.clear();
  for (const uvec3& t : p.shape(*index_among(p.object_entities, *entity)).triangles())
    out.insert(out.end(), {t.x, t.y, t.z});
  return Done{};
}

// The nearest of what `find` gives for each object: TrianglePlace(boxes, within).
template <class Find>
static Result<QueryHit> nearest(SessionRun& p, const QueryOptions& options, const char* what, const Find& find) {
  const auto objects = asked(p, options, what);
  if (!objects) return objects.error();
  p.see();
  QueryHit best;
  double within = options.within;
  for (const std::size_t object : *objects) {
    const std::optional<TriangleBoxes>& boxes = boxes_of(p, object, options.rest);
    const TrianglePlace place = find(*boxes, within);
    if (!place.found() || (best.found() && place.distance >= within)) continue;
    within = place.distance;
    best = hit_of(*boxes, static_cast<std::uint32_t>(object), place);
  }
  return best;
}

Result<QueryHit> Session::closest_point(dvec3 point, const QueryOptions& options) {
  SessionRun& p = *run_;
  if (!is_finite(point)) return Error{"Session::closest_point", "the point is no number", "check it"};
  return nearest(p, options, "Session::closest_point",
                 [&](const TriangleBoxes& boxes, double within) { return boxes.closest(point, within); });
}

Result<QueryHit> Session::ray(dvec3 from, dvec3 direction, const QueryOptions& options) {
  SessionRun& p = *run_;
  const double size = length(direction);
  if (!is_finite(from) || !(size > 0.0) || !std::isfinite(size))
    return Error{"Session::ray", "its origin is no number, or its direction has no length", "check both"};
  return nearest(p, options, "Session::ray", [&](const TriangleBoxes& boxes, double within) {
    return boxes.first_along(from, direction / size, within);
  });
}

Result<Bounds> Session::bounds(const QueryOptions& options) {
  SessionRun& p = *run_;
  const auto objects = asked(p, options, "Session::bounds");
  if (!objects) return objects.error();
  p.see();
  Bounds all{dvec3(std::numeric_limits<double>::max()), dvec3(std::numeric_limits<double>::lowest())};
  for (const std::size_t object : *objects) {
    const std::optional<TriangleBoxes>& boxes = boxes_of(p, object, options.rest);
    if (boxes->empty()) continue;
    all.min = glm::min(all.min, boxes->low());
    all.max = glm::max(all.max, boxes->high());
  }
  if (all.min.x > all.max.x)
    return Error{"Session::bounds", "the scene has no object", "add one with Scene::add_surface"};
  return all;
}

}  // namespace pliant
