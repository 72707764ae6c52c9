#include "content/mesh/mesh_draw.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace pliant {
namespace {

// Normalises v; `otherwise` if v has no direction.
vec3 unit_or(dvec3 v, vec3 otherwise) {
  const double l = length(v);
  return std::isfinite(l) && l > 1e-30 ? vec3(v / l) : otherwise;
}

auto looks(const DrawVertex& v) {
  return std::make_tuple(v.normal.x, v.normal.y, v.normal.z, v.uv.x, v.uv.y, v.tangent.x, v.tangent.y, v.tangent.z,
                         v.tangent.w);
}

// The file's data of source vertex `v` of `p`. tangent.w 0: tangent not yet computed.
DrawVertex drawn(const Primitive& p, std::size_t v, std::uint32_t touch_vertex, const Mesh& mesh, const Directions& to,
                 bool turned) {
  DrawVertex d;
  d.position = mesh.position(touch_vertex);
  d.touch_vertex = touch_vertex;
  d.normal = mesh.normal(touch_vertex);
  if (p.normal.size() == p.position.size())
    d.normal = unit_or(to.normal * dvec3(p.normal[v]) * (turned ? -1.0 : 1.0), d.normal);
  const bool has_uv = p.uv.size() == p.position.size();
  if (has_uv && std::isfinite(p.uv[v].x) && std::isfinite(p.uv[v].y)) d.uv = p.uv[v] + vec2(0.0f);
  const vec3 x = std::abs(d.normal.x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 any = normalize(x - d.normal * dot(x, d.normal));
  if (p.tangent.size() == p.position.size())
    d.tangent = vec4(unit_or(to.tangent * dvec3(vec3(p.tangent[v])), any),
                     (p.tangent[v].w < 0.0f) != turned ? -to.hand : to.hand);
  else
    d.tangent = vec4(any, has_uv ? 0.0f : 1.0f);
  return d;
}

// Triangles grouped by material, each group in the order given.
void group_by_material(DrawMesh& draw, const std::vector<uvec3>& triangles, const std::vector<std::int32_t>& material) {
  std::vector<std::int32_t> order(material);
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  const auto group_of = [&](std::int32_t m) {
    return static_cast<std::size_t>(std::lower_bound(order.begin(), order.end(), m) - order.begin());
  };
  for (const std::int32_t m : order) draw.parts.push_back({0, 0, m});
  for (const std::int32_t m : material) draw.parts[group_of(m)].index_count += 3;
  std::vector<std::uint32_t> next(order.size(), 0);
  for (std::size_t i = 0, first = 0; i < draw.parts.size(); first += draw.parts[i++].index_count)
    next[i] = draw.parts[i].first_index = static_cast<std::uint32_t>(first);
  draw.indices.resize(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::uint32_t& place = next[group_of(material[i])];
    for (int corner = 0; corner < 3; ++corner) draw.indices[place++] = triangles[i][corner];
  }
}

// If the file has no normals, computed normals are split at creases, so that rendering matches touch.
class SplitNormals {
 public:
  SplitNormals(const Mesh& mesh, DrawMesh& draw) : mesh_(mesh), draw_(draw) {}

  // Returns `vertex`, or its copy with the normal of this corner.
  std::uint32_t of(std::uint32_t vertex, std::uint32_t triangle, int corner) {
    const vec3 normal = mesh_.normal(triangle, corner);
    if (normal == draw_.vertices[vertex].normal) return vertex;
    const auto [known, fresh] =
        copies_.try_emplace({vertex, normal.x, normal.y, normal.z}, static_cast<std::uint32_t>(draw_.vertices.size()));
    if (fresh) {
      DrawVertex copy = draw_.vertices[vertex];
      copy.normal = normal;
      const vec3 along(copy.tangent);
      copy.tangent = vec4(across(normal, along), copy.tangent.w);
      draw_.vertices.push_back(copy);
    }
    return known->second;
  }

 private:
  // A unit vector in the tangent plane, along `preferred` if possible.
  static vec3 across(vec3 normal, vec3 preferred) {
    const vec3 x = std::abs(normal.x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 any = normalize(x - normal * dot(x, normal));
    return unit_or(dvec3(preferred - normal * dot(preferred, normal)), any);
  }

  const Mesh& mesh_;
  DrawMesh& draw_;
  std::map<std::tuple<std::uint32_t, float, float, float>, std::uint32_t> copies_;
};

}  // namespace

DrawMesh build_draw_mesh(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                         const Welded& welded, const Mesh& mesh, MeshReport& report) {
  // All touched triangles are drawn, and the back sides of double-sided sheets.
  std::vector<std::uint32_t> source_triangles(welded.source_triangle);
  source_triangles.insert(source_triangles.end(), welded.backs.begin(), welded.backs.end());
  std::vector<std::uint32_t> draw_vertex(gathered.position.size(), kNoVertex);
  std::vector<std::uint8_t> shown(gathered.position.size(), 0);
  std::vector<std::uint8_t> primitive_shown(primitives.size(), 0);
  for (const std::uint32_t s : source_triangles) {
    for (int i = 0; i < 3; ++i) shown[gathered.triangle[s][i]] = 1;
    primitive_shown[gathered.primitive[s]] = 1;
  }

  // Identical copies of a touch vertex are merged into one draw vertex.
  DrawMesh draw;
  const Directions directions(to_object);
  std::vector<std::pair<DrawVertex, std::uint32_t>> copies;
  for (std::size_t begin = 0; begin < welded.sources.size();) {
    const std::uint32_t touch_vertex = welded.touch_vertex[welded.sources[begin]];
    copies.clear();
    std::size_t end = begin;
    for (; end < welded.sources.size() && welded.touch_vertex[welded.sources[end]] == touch_vertex; ++end) {
      const std::uint32_t source = welded.sources[end];
      if (!shown[source]) continue;
      const auto after = std::upper_bound(gathered.first_vertex.begin(), gathered.first_vertex.end(), source);
      const auto n = static_cast<std::size_t>(after - gathered.first_vertex.begin()) - 1;
      copies.emplace_back(drawn(primitives[n], source - gathered.first_vertex[n], touch_vertex, mesh, directions,
                                !gathered.turned_normal.empty() && gathered.turned_normal[source] != 0),
                          source);
    }
    if (copies.size() > 1)
      std::sort(copies.begin(), copies.end(), [](const auto& a, const auto& b) {
        const auto la = looks(a.first), lb = looks(b.first);
        return la != lb ? la < lb : a.second < b.second;
      });
    for (std::size_t i = 0; i < copies.size(); ++i) {
      if (i == 0 || looks(copies[i].first) != looks(copies[i - 1].first)) draw.vertices.push_back(copies[i].first);
      draw_vertex[copies[i].second] = static_cast<std::uint32_t>(draw.vertices.size() - 1);
    }
    begin = end;
  }

  std::vector<uvec3> triangles;
  std::vector<std::int32_t> material;
  triangles.reserve(source_triangles.size());
  material.reserve(source_triangles.size());
  SplitNormals split(mesh, draw);
  for (std::size_t i = 0; i < source_triangles.size(); ++i) {
    const std::uint32_t s = source_triangles[i];
    const uvec3 t = gathered.triangle[s];
    triangles.emplace_back(draw_vertex[t.x], draw_vertex[t.y], draw_vertex[t.z]);
    const Primitive& p = primitives[gathered.primitive[s]];
    const bool touched = i < mesh.triangles.size();
    if (touched && !mesh.split_normals.empty() && mesh.split_normals[i] != kNotSplit &&
        p.normal.size() != p.position.size())
      for (int corner = 0; corner < 3; ++corner)
        triangles.back()[corner] = split.of(triangles.back()[corner], static_cast<std::uint32_t>(i), corner);
    material.push_back(primitives[gathered.primitive[s]].material);
  }
  group_by_material(draw, triangles, material);

  for (std::size_t n = 0; n < primitives.size(); ++n) {
    if (!primitive_shown[n]) continue;
    const Primitive& p = primitives[n];
    report.made_normals |= p.normal.size() != p.position.size();
    report.made_tangents |= p.uv.size() == p.position.size() && p.tangent.size() != p.position.size();
  }
  if (report.made_tangents) make_tangents(draw);
  return draw;
}

void make_tangents(DrawMesh& draw) {
  const std::size_t original = draw.vertices.size();
  std::vector<dvec3> sum(original, dvec3(0));
  std::vector<float> hand(original, 0.0f);               // handedness of the triangles that first used this vertex
  std::vector<std::uint32_t> twin(original, kNoVertex);  // the copy of opposite handedness
  for (std::size_t i = 0; i + 2 < draw.indices.size(); i += 3) {
    std::uint32_t* index = &draw.indices[i];
    const DrawVertex a = draw.vertices[index[0]], b = draw.vertices[index[1]], c = draw.vertices[index[2]];
    const dvec2 ub = dvec2(b.uv) - dvec2(a.uv), uc = dvec2(c.uv) - dvec2(a.uv);
    const double uv_area = ub.x * uc.y - uc.x * ub.y;
    if (uv_area == 0.0) continue;  // no direction here; the vertex's other triangles decide
    const float side = uv_area < 0.0 ? -1.0f : 1.0f;
    const dvec3 grows_u =
        ((dvec3(b.position) - dvec3(a.position)) * uc.y - (dvec3(c.position) - dvec3(a.position)) * ub.y) *
        double(side);

    for (int corner = 0; corner < 3; ++corner) {
      std::uint32_t v = index[corner];
      if (draw.vertices[v].tangent.w != 0.0f) continue;  // given in the file
      if (hand[v] == 0.0f) hand[v] = side;
      if (hand[v] != side) {
        if (twin[v] == kNoVertex) {
          twin[v] = static_cast<std::uint32_t>(draw.vertices.size());
          draw.vertices.push_back(DrawVertex(draw.vertices[v]));
          sum.emplace_back(0);
          hand.push_back(side);
          twin.push_back(v);
        }
        v = index[corner] = twin[v];
      }
      const dvec3 n(draw.vertices[v].normal), p(draw.vertices[v].position);
      const dvec3 e = dvec3(draw.vertices[index[(corner + 1) % 3]].position) - p;
      const dvec3 f = dvec3(draw.vertices[index[(corner + 2) % 3]].position) - p;
      const dvec3 along = grows_u - n * dot(n, grows_u);
      const double l = length(along);
      if (l > 0.0) sum[v] += along * (std::atan2(length(cross(e, f)), dot(e, f)) / l);
    }
  }
  for (std::size_t v = 0; v < draw.vertices.size(); ++v) {
    vec4& tangent = draw.vertices[v].tangent;
    if (tangent.w == 0.0f) tangent = vec4(unit_or(sum[v], vec3(tangent)), hand[v] < 0.0f ? -1.0f : 1.0f);
  }
}

}  // namespace pliant
