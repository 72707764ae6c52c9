#include "content/tets/tet_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/tets/tet_quality.h"

namespace pliant {
namespace {

constexpr double kLeastCells = 1.2;  // [cells] thickness of a wall that stays connected

}  // namespace

std::string length_text(double metres) {
  if (metres < 0.01) return fmt::format("{:.2g} mm", 1e3 * metres);
  if (metres < 1.0) return fmt::format("{:.2g} cm", 1e2 * metres);
  return fmt::format("{:.3g} m", metres);
}

double least_wall(const Mesh& surface, bool doubled) {
  double area = 0.0;
  for (const uvec3& t : surface.triangles) {
    const dvec3 a(surface.position(t.x));
    area += 0.5 * length(cross(dvec3(surface.position(t.y)) - a, dvec3(surface.position(t.z)) - a));
  }
  if (doubled) area *= 0.5;
  return kLeastCells * std::sqrt(kTetsPerCell * kLeastCells * area / static_cast<double>(kUsualTets));
}

void report_wall(const SurfaceShape& shape, Fill fill, double thickness, TetReport& report) {
  const auto note = [&](std::string what, std::string cure = {}) {
    report.notes.push_back({std::move(what), std::move(cure), kFillNote, {}});
  };
  if (shape.kind == SurfaceKind::kSheet) {
    if (fill == Fill::kWall)
      note("is an open surface", fmt::format("tissue of {} lies behind it", length_text(thickness)));
    else
      note("is an open surface: what it half encloses is filled",
           "close it, or give it a thickness (\"fill\": \"wall\", \"thickness\" in metres)");
    return;
  }
  if (shape.kind == SurfaceKind::kWall) {
    report.wall = shape.thickness;
    const std::string wall = "is a wall of " + length_text(shape.thickness);
    if (fill == Fill::kSolid)
      note(wall + ", its inside is filled (\"fill\": \"solid\") and its inner sheet left out",
           "to keep it hollow, give it thickness (\"fill\": \"wall\", \"thickness\" in metres)");
    else if (thickness > shape.thickness)
      report.notes.push_back({wall + ", made " + length_text(thickness) + " thick inwards", {}, "tissue.wall", {}});
    else
      note(wall + ", filled as it is",
           "fill the inside (\"fill\": \"solid\"), or give it a larger `thickness`, where that is too thin to hold");
    return;
  }
  if (fill == Fill::kWall && !(thickness > 0.0))
    note("is no thin wall, so \"fill\": \"wall\" changes nothing", "give it a `thickness`, or leave `fill` out");
}

void report_thin_places(const SurfaceShape& shape, const FillRegion& region, const LatticeOptions& options,
                        TetMesh& mesh) {
  if (shape.samples.empty() || !mesh.cells.empty()) return;  // whole cells have the section of what is thin
  TetReport& report = mesh.report;
  const double cells = options.cell > 0.0 ? kThinCellsOfNamed : kThinCells;
  const auto width_at = [&](dvec3 place) { return options.focus ? options.focus->width_at(place) : 1.0; };
  std::vector<std::pair<double, const ThicknessSample*>> thin;
  for (const ThicknessSample& sample : shape.samples)
    if (const double t = region.thickness_at(sample); t > 0.0 && t < cells * report.cell * width_at(sample.place))
      thin.emplace_back(t, &sample);
  report.thin = static_cast<double>(thin.size()) / static_cast<double>(shape.samples.size());
  if (report.thin < kThinShare) return;
  std::sort(thin.begin(), thin.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  // Not the thinnest of all, which is an edge: the median of the thin places.
  const auto& [least, at] = thin[thin.size() / 2];
  report.least_thickness = least;
  report.thinnest = vec3(at->place);
  const double width = width_at(at->place), cell = least / kHeldCells / width;
  const double tets = options.focus ? static_cast<double>(mesh.tets.size()) * std::pow(report.cell / cell, 3)
                                    : kTetsPerCell * total_volume(mesh) / (cell * cell * cell);
  report.notes.push_back(
      {fmt::format("is thin over {:.0f} % of its surface, {} at ({:.3g}, {:.3g}, {:.3g}) m, for a cell of {}: it bends "
                   "there as single elements do, or crumples",
                   1e2 * report.thin, length_text(least), at->place.x, at->place.y, at->place.z,
                   length_text(report.cell * width)),
       fmt::format("a `cell` of {:.2g} m holds it, with some {:.0f} tetrahedra", cell, tets),
       "tissue.thin",
       {}});
}

void report_parts(std::uint32_t kept, std::uint32_t of_surface, TetReport& report) {
  if (report.parts_dropped > 0)
    report.notes.push_back(
        {fmt::format("lost {} part{} too small to keep ({:.2g} % of its tissue)", report.parts_dropped,
                     report.parts_dropped == 1 ? "" : "s", 1e2 * report.volume_dropped),
         "the surface there rides on what is nearest",
         "tissue.parts_lost",
         {}});
  if (kept > of_surface)
    report.notes.push_back({fmt::format("its tetrahedra fall into {} parts where its surface has {}: what joins them "
                                        "is thinner than the cell",
                                        kept, of_surface),
                            "make `cell` smaller",
                            "tissue.falls_apart",
                            {}});
}

}  // namespace pliant
