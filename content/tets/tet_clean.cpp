#include "content/tets/tet_clean.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/tets/lattice.h"
#include "content/tets/tet_quality.h"

namespace pliant {
namespace {

constexpr double kFarthestNode = 1e9;  // [m]
// Six volumes over the cube of the longest edge from a corner (0.7 for a regular tetrahedron). Below it, an element
// counts as flat.
constexpr double kFlat = 1e-8;
constexpr std::size_t kMostGroups = 60'000;  // physical groups that are distinguished

double longest_edge(std::span<const dvec3> nodes, const Tet& t) {
  double longest = 0.0;
  for (std::size_t i = 1; i < 4; ++i) longest = std::max(longest, length(nodes[t[i]] - nodes[t[0]]));
  return longest;
}

std::string count(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace

Result<TetFile> clean(RawTets raw, const std::string& name) {
  TetFile out;
  out.notes = std::move(raw.notes);
  const auto note = [&](std::size_t n, const char* one, const char* many) {
    if (n > 0) out.notes.push_back(count(n, one, many));
  };
  if (raw.tets.size() > most(limits::kTets))
    return error_at(name, beyond("holds", limits::kTets, static_cast<double>(raw.tets.size()), "make a coarser mesh"));
  for (const dvec3& p : raw.nodes)
    if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthestNode))
      return Error{name, "has a node that is not a finite number within 1e9 m", "repair it, or scale it down"};

  // Groups are numbered from 1 on, in the order of their tags.
  std::map<std::int64_t, std::uint16_t> number_of{{0, std::uint16_t{0}}};
  std::vector<std::int64_t> tags = raw.group;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (const std::int64_t tag : tags) {
    if (tag == 0 || out.groups.size() >= kMostGroups) continue;
    const auto named = raw.names.find(tag);
    out.groups.push_back(named == raw.names.end() ? fmt::format("{}", tag) : named->second);
    number_of[tag] = static_cast<std::uint16_t>(out.groups.size());
  }

  std::size_t flat = 0, turned = 0;
  out.tets.reserve(raw.tets.size());
  for (std::size_t n = 0; n < raw.tets.size(); ++n) {
    Tet t = raw.tets[n];
    const double longest = longest_edge(raw.nodes, t), size = 6.0 * tet_volume(raw.nodes, t);
    if (!(std::abs(size) > kFlat * longest * longest * longest)) {
      ++flat;
      continue;
    }
    if (size < 0.0) {
      ++turned;
      std::swap(t[2], t[3]);
    }
    out.tets.push_back(t);
    if (out.groups.empty()) continue;
    const auto found = number_of.find(raw.group[n]);
    out.group.push_back(found == number_of.end() ? std::uint16_t{0} : found->second);
  }
  if (out.tets.empty())
    return raw.tets.empty()
               ? Error{name, "holds no tetrahedra", "fill the mesh with first-order tetrahedra and save again"}
               : Error{name, "holds only tetrahedra without volume", "repair the mesh"};

  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(raw.nodes.size(), kUnused);
  for (const Tet& t : out.tets)
    for (const std::uint32_t corner : t) number[corner] = 0;
  for (std::uint32_t n = 0; n < number.size(); ++n) {
    if (number[n] == kUnused) continue;
    number[n] = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes.push_back(raw.nodes[n]);
  }
  for (Tet& t : out.tets)
    for (std::uint32_t& corner : t) corner = number[corner];

  note(raw.second_order, "tetrahedron of higher order: only its corners are taken",
       "tetrahedra of higher order: only their corners are taken");
  note(raw.other_cells, "cell that is no tetrahedron: skipped", "cells that are no tetrahedra: skipped");
  note(turned, "inverted tetrahedron: turned", "inverted tetrahedra: turned");
  note(flat, "tetrahedron without volume: dropped", "tetrahedra without volume: dropped");
  note(raw.nodes.size() - out.nodes.size(), "node that no tetrahedron names: dropped",
       "nodes that no tetrahedron names: dropped");
  return out;
}

}  // namespace pliant
