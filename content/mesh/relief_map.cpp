#include "content/mesh/relief_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "runtime/long_work.h"

namespace pliant {
namespace {

constexpr std::uint32_t kMostTexels = 1024;  // a side; larger maps are averaged: a hand feels no finer
constexpr double kSameCoordinate = 1e-4;     // [1] of the map
constexpr double kSteepestDrawn = 8.0;       // [1] a normal map's slope: 83 degrees

std::uint32_t power_of_two(std::uint32_t size) {
  std::uint32_t n = 1;
  while (2 * n <= std::min(size, kMostTexels)) n *= 2;
  return n;
}

// A channel of an image, averaged to other sizes: each new texel over what it covers.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<double> value;
};
Picture channel_of(const Image& image, int channel, std::uint32_t width, std::uint32_t height) {
  Picture out{width, height, std::vector<double>(std::size_t{width} * height)};
  const double across = static_cast<double>(image.width) / width, down = static_cast<double>(image.height) / height;
  const auto average = [](double from, double to, std::uint32_t size, auto at) {
    double sum = 0.0;
    for (auto i = static_cast<std::uint32_t>(from); i < size && i < to; ++i)
      sum += (std::min(to, i + 1.0) - std::max(from, static_cast<double>(i))) * at(i);
    return sum / (to - from);
  };
  for (std::uint32_t y = 0; y < height; ++y) {
    if (y % 64 == 0) check_in();
    for (std::uint32_t x = 0; x < width; ++x)
      out.value[std::size_t{y} * width + x] = average(y * down, (y + 1) * down, image.height, [&](std::uint32_t j) {
        return average(x * across, (x + 1) * across, image.width, [&](std::uint32_t i) {
          return image.rgba[4 * (std::size_t{j} * image.width + i) + static_cast<std::size_t>(channel)] / 255.0;
        });
      });
  }
  return out;
}

// Triangles with one map, and their mean metric: metres and drawn slopes per coordinate.
struct MapChart {
  std::int32_t material = -1;
  bool tiled = false;
  double area = 0.0;                // [1] of the coordinates
  double across = 0.0, down = 0.0;  // [m] per u, per v, times area
  double longest = 0.0;             // [m] per coordinate
  dmat2 by_slopes{0.0};             // [m] d h / d (u, v) by the slopes along tangent and bitangent, times area
};

struct Corners3 {
  std::array<std::uint32_t, 3> vertex;  // draw vertices in the order of the touch triangle
};

// Per touch triangle its draw triangle and material; material -2: none.
struct Placed {
  std::vector<Corners3> corners;
  std::vector<std::int32_t> material;
};
Placed place_triangles(const Mesh& mesh, const DrawMesh& draw) {
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
  const auto key = [](std::array<std::uint32_t, 3> t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 c = mesh.triangles[t];
    known.emplace(key({c.x, c.y, c.z}), t);
  }
  Placed out{std::vector<Corners3>(mesh.triangles.size()), std::vector<std::int32_t>(mesh.triangles.size(), -2)};
  for (const DrawPart& part : draw.parts)
    for (std::uint32_t i = part.first_index; i + 2 < part.first_index + part.index_count; i += 3) {
      std::array<std::uint32_t, 3> touch;
      for (std::size_t k = 0; k < 3; ++k) touch[k] = draw.vertices[draw.indices[i + k]].touch_vertex;
      const auto found = known.find(key(touch));
      if (found == known.end() || out.material[found->second] != -2) continue;
      const uvec3 c = mesh.triangles[found->second];
      for (int k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j)
          if (touch[j] == c[k]) out.corners[found->second].vertex[static_cast<std::size_t>(k)] = draw.indices[i + j];
      out.material[found->second] = part.material;
    }
  return out;
}

// [m] per u and per v of a triangle, and twice its area over the coordinates. False: it has no coordinates.
struct Metric {
  dvec3 by_u, by_v;
  double area = 0.0;
};
bool metric_of(const DrawMesh& draw, const Corners3& corners, Metric& out) {
  const DrawVertex &a = draw.vertices[corners.vertex[0]], &b = draw.vertices[corners.vertex[1]],
                   &c = draw.vertices[corners.vertex[2]];
  const dvec2 ub = dvec2(b.uv) - dvec2(a.uv), uc = dvec2(c.uv) - dvec2(a.uv);
  const dvec3 xb = dvec3(b.position) - dvec3(a.position), xc = dvec3(c.position) - dvec3(a.position);
  const double area = ub.x * uc.y - uc.x * ub.y;
  if (!std::isfinite(area) || std::abs(area) < 1e-18) return false;
  out = {(xb * uc.y - xc * ub.y) / area, (xc * ub.x - xb * uc.x) / area, std::abs(area)};
  return std::isfinite(length(out.by_u)) && std::isfinite(length(out.by_v));
}

std::vector<HeightMap> map_of(const MapChart& chart, const Material& material, const std::vector<Image>& images) {
  const auto image_of = [&](std::int32_t index) -> const Image* {
    if (index < 0 || static_cast<std::size_t>(index) >= images.size()) return nullptr;
    const Image& image = images[static_cast<std::size_t>(index)];
    return image.width > 0 && image.rgba.size() >= 4 * std::size_t{image.width} * image.height ? &image : nullptr;
  };
  const Image *normals = image_of(material.normal_texture),
              *heights = material.height_scale > 0.0f ? image_of(material.height_texture) : nullptr;
  if (!normals && !heights) return {};
  std::uint32_t width = 1, height = 1;
  for (const Image* each : {normals, heights})
    if (each) width = std::max(width, power_of_two(each->width)), height = std::max(height, power_of_two(each->height));
  std::vector<float> sum(std::size_t{width} * height, 0.0f);
  if (normals) {
    const Picture x = channel_of(*normals, 0, width, height), y = channel_of(*normals, 1, width, height),
                  z = channel_of(*normals, 2, width, height);
    std::vector<vec2> slope(sum.size());
    const dmat2 by = chart.by_slopes / chart.area;
    for (std::size_t i = 0; i < slope.size(); ++i) {
      const double up = std::max(2 * z.value[i] - 1, 1e-3), scale = static_cast<double>(material.normal_scale);
      const dvec2 drawn = dvec2(-scale * (2 * x.value[i] - 1) / up, -scale * (2 * y.value[i] - 1) / up);
      const dvec2 by_uv = by * glm::clamp(drawn, -kSteepestDrawn, kSteepestDrawn);
      slope[i] = vec2(static_cast<float>(by_uv.x / width), static_cast<float>(by_uv.y / height));
    }
    sum = integrate_slopes(width, height, slope, chart.tiled);
  }
  if (heights) {
    const Picture red = channel_of(*heights, 0, width, height);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += material.height_scale * static_cast<float>(red.value[i]);
  }
  return height_levels(width, height, std::move(sum), chart.tiled,
                       std::min(chart.across / chart.area / width, chart.down / chart.area / height));
}

// Coordinates and chart of each triangle that a material's relief is drawn on.
std::vector<MapChart> take_charts(const Placed& placed, const DrawMesh& draw, const std::vector<Material>& materials,
                                  Relief& relief) {
  std::vector<MapChart> charts;
  for (std::size_t t = 0; t < relief.map_of.size(); ++t) {
    const std::int32_t material = placed.material[t];
    Metric metric;
    if (material < 0 || !draws_relief(materials[static_cast<std::size_t>(material)]) ||
        !metric_of(draw, placed.corners[t], metric))
      continue;
    auto chart = std::find_if(charts.begin(), charts.end(), [&](const MapChart& c) { return c.material == material; });
    if (chart == charts.end()) {
      if (charts.size() == Relief::kNone) continue;  // more maps than a mesh has materials
      chart = charts.insert(charts.end(), MapChart{});
      chart->material = material;
    }
    relief.map_of[t] = static_cast<std::uint8_t>(chart - charts.begin());
    const double along_u = length(metric.by_u), along_v = length(metric.by_v);
    chart->area += metric.area;
    chart->across += metric.area * along_u;
    chart->down += metric.area * along_v;
    chart->longest = std::max({chart->longest, along_u, along_v});
    for (std::size_t k = 0; k < 3; ++k) {
      const DrawVertex& v = draw.vertices[placed.corners[t].vertex[k]];
      relief.uv[t][k] = dvec2(v.uv);
      const bool outside = v.uv.x < -0.01f || v.uv.x > 1.01f || v.uv.y < -0.01f || v.uv.y > 1.01f;
      chart->tiled = chart->tiled || outside;
      const dvec3 n(v.normal);
      dvec3 tangent = dvec3(v.tangent) - n * dot(n, dvec3(v.tangent));
      if (!(length(tangent) > 1e-6)) continue;
      tangent = normalize(tangent);
      const dvec3 bitangent = static_cast<double>(v.tangent.w) * cross(n, tangent);
      // Columns: by the slope along the tangent, by that along the bitangent.
      chart->by_slopes[0] += metric.area / 3 * dvec2(dot(tangent, metric.by_u), dot(tangent, metric.by_v));
      chart->by_slopes[1] += metric.area / 3 * dvec2(dot(bitangent, metric.by_u), dot(bitangent, metric.by_v));
    }
  }
  return charts;
}

// Vertices whose triangles disagree: on a seam, or where another material begins.
std::vector<std::uint8_t> seams_of(const Mesh& mesh, const Relief& relief, const std::vector<MapChart>& charts) {
  std::vector<std::uint32_t> first(mesh.vertex_count, kBorder);
  std::vector<std::uint8_t> seam(mesh.vertex_count, 0);
  const auto differ = [&](std::uint32_t a, std::uint32_t b, std::uint32_t vertex) {
    if (relief.map_of[a] != relief.map_of[b]) return true;
    if (relief.map_of[a] == Relief::kNone) return false;
    const auto uv = [&](std::uint32_t t) {
      std::size_t k = 0;
      while (k < 2 && mesh.triangles[t][static_cast<int>(k)] != vertex) ++k;
      return relief.uv[t][k];
    };
    dvec2 d = uv(a) - uv(b);
    if (charts[relief.map_of[a]].tiled) d -= glm::round(d);
    return length(d) > kSameCoordinate;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (first[v] == kBorder)
        first[v] = t;
      else if (differ(first[v], t, v))
        seam[v] = 1;
    }
  return seam;
}

// Relief ends at seams. Returns the share of the drawn area that fades; below 0: none is drawn.
double fade_at(const std::vector<std::uint8_t>& seam, const Mesh& mesh, Relief& relief) {
  double area = 0.0, faded = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (relief.map_of[t] == Relief::kNone) continue;
    const uvec3 c = mesh.triangles[t];
    const double its = length(cross(dvec3(mesh.position(c.y)) - dvec3(mesh.position(c.x)),
                                    dvec3(mesh.position(c.z)) - dvec3(mesh.position(c.x))));
    area += its;
    for (int k = 0; k < 3; ++k)
      if (seam[c[k]]) {
        relief.strength[t][static_cast<std::size_t>(k)] = 0.0f;
        faded += its / 3;
      }
  }
  return area > 0.0 ? faded / area : -1.0;
}

}  // namespace

bool draws_relief(const Material& material) {
  return material.normal_texture >= 0 || (material.height_texture >= 0 && material.height_scale > 0.0f);
}

ReliefMaps relief_maps(const Mesh& mesh, const DrawMesh& draw, const std::vector<Material>& materials,
                       const std::vector<Image>& images) {
  ReliefMaps out;
  const auto relief = std::make_shared<Relief>();
  const std::size_t count = mesh.triangles.size();
  relief->map_of.assign(count, Relief::kNone);
  relief->uv.resize(count);
  relief->strength.resize(count, {1.0f, 1.0f, 1.0f});
  const std::vector<MapChart> charts = take_charts(place_triangles(mesh, draw), draw, materials, *relief);
  if (charts.empty()) return out;
  for (const MapChart& chart : charts) {
    relief->maps.push_back(map_of(chart, materials[static_cast<std::size_t>(chart.material)], images));
    out.uneven = std::max(out.uneven, chart.longest * chart.area / std::max(std::max(chart.across, chart.down), 1e-30));
  }
  for (std::uint8_t& map : relief->map_of)
    if (map != Relief::kNone && relief->maps[map].empty()) map = Relief::kNone;
  const double faded = fade_at(seams_of(mesh, *relief, charts), mesh, *relief);
  if (faded < 0.0) return out;
  out.faded = faded;
  out.relief = relief;
  return out;
}

}  // namespace pliant
