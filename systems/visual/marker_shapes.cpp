#include "systems/visual/marker_shapes.h"

#include <cmath>
#include <numbers>

namespace pliant {
namespace {

constexpr std::uint32_t kSides = 32, kRows = 16;
constexpr float kPiOfMarker = std::numbers::pi_v<float>;

struct ProfilePoint {
  float radius, y;
  vec2 normal;  // outward in the (radius, y) plane, unit
};

// Revolves each pair of profile points (upper end first) about the y axis into a band.
void turn(MarkerMesh& mesh, const std::vector<ProfilePoint>& profile) {
  for (std::size_t row = 0; row + 1 < profile.size(); row += 2) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t side = 0; side <= kSides; ++side) {
      const float angle = 2 * kPiOfMarker * static_cast<float>(side) / kSides, c = std::cos(angle), s = std::sin(angle);
      for (std::size_t end = row; end < row + 2; ++end) {
        const ProfilePoint& p = profile[end];
        mesh.vertices.push_back({{p.radius * c, p.y, p.radius * s}, {p.normal.x * c, p.normal.y, p.normal.x * s}});
      }
    }
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t a = first + 2 * side, b = a + 1, c = a + 2, d = a + 3;
      mesh.indices.insert(mesh.indices.end(), {a, d, b, a, c, d});
    }
  }
}

}  // namespace

MarkerMesh make_ball() {
  MarkerMesh mesh;
  std::vector<ProfilePoint> profile;
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t end = row; end < row + 2; ++end) {
      const float polar = kPiOfMarker * static_cast<float>(end) / kRows, r = std::sin(polar), y = std::cos(polar);
      profile.push_back({r, y, {r, y}});
    }
  turn(mesh, profile);
  return mesh;
}

MarkerMesh make_rod() {
  MarkerMesh mesh;
  turn(mesh, {{0, 1, {0, 1}}, {1, 1, {0, 1}}, {1, 1, {1, 0}}, {1, 0, {1, 0}}});
  return mesh;
}

MarkerMesh make_cone() {
  MarkerMesh mesh;
  const vec2 slope = normalize(vec2(1, 1));
  turn(mesh, {{0, 1, slope}, {1, 0, slope}, {1, 0, {0, -1}}, {0, 0, {0, -1}}});
  return mesh;
}

}  // namespace pliant
