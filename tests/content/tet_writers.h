// One mesh of tetrahedra in every supported format, written from the formats' public descriptions.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "content/tets/tet_file.h"

namespace pliant::test {

using NodesAndTets = std::pair<std::vector<dvec3>, std::vector<Tet>>;

// Values as text or as bytes; big-endian if `swapped`.
class TetWriter {
 public:
  TetWriter(bool binary, bool swapped) : binary_(binary), swapped_(swapped) {}
  TetWriter& text(const std::string& t) {
    out_ += t;
    return *this;
  }
  template <class T>
  TetWriter& value(T v) {
    if (!binary_) return text(fmt::format("{} ", v));
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    if (swapped_) std::reverse(bytes, bytes + sizeof v);
    out_.append(bytes, sizeof v);
    return *this;
  }
  TetWriter& point(dvec3 p) { return value(p.x).value(p.y).value(p.z); }
  TetWriter& line() { return binary_ ? *this : text("\n"); }
  std::string take() { return std::move(out_); }

 private:
  bool binary_, swapped_;
  std::string out_;
};

inline std::string msh_2(const NodesAndTets& mesh, bool binary, bool swapped) {
  TetWriter w(binary, swapped);
  w.text(fmt::format("$MeshFormat\n2.2 {} 8\n", int(binary)));
  if (binary) w.value(std::int32_t{1}).text("\n");
  w.text(fmt::format("$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"tissue\"\n$EndPhysicalNames\n$Nodes\n{}\n",
                     mesh.first.size()));
  for (std::size_t n = 0; n < mesh.first.size(); ++n)
    w.value(std::int32_t(7 + 2 * n)).point(mesh.first[n]).line();  // tags with gaps
  w.text(fmt::format("\n$EndNodes\n$Elements\n{}\n", mesh.second.size() + 1));
  // A triangle on the boundary first.
  const auto tag = [](std::uint32_t node) { return std::int32_t(7 + 2 * node); };
  const Tet first = mesh.second[0];
  if (binary)
    w.value(std::int32_t{2}).value(std::int32_t{1}).value(std::int32_t{2}).value(std::int32_t{1});
  else
    w.text("1 2 2 ");
  w.value(std::int32_t{1}).value(std::int32_t{1}).value(tag(first[0])).value(tag(first[1])).value(tag(first[2])).line();
  if (binary) w.value(std::int32_t{4}).value(std::int32_t(mesh.second.size())).value(std::int32_t{2});
  for (std::size_t t = 0; t < mesh.second.size(); ++t) {
    w.value(std::int32_t(t + 2));
    if (!binary) w.text("4 2 ");
    w.value(std::int32_t{1}).value(std::int32_t{1});
    for (const std::uint32_t corner : mesh.second[t]) w.value(tag(corner));
    w.line();
  }
  return w.text("\n$EndElements\n").take();
}

inline std::string msh_4(const NodesAndTets& mesh, bool binary, bool swapped) {
  TetWriter w(binary, swapped);
  const std::size_t count = mesh.first.size(), tets = mesh.second.size(), half = count / 2;
  w.text(fmt::format("$MeshFormat\n4.1 {} 8\n", int(binary)));
  if (binary) w.value(std::int32_t{1}).text("\n");
  w.text("$EndMeshFormat\n$Nodes\n");
  // Two blocks, the first with a parameter, tags downwards.
  const auto tag = [&](std::size_t node) { return std::uint64_t(3 * (count - node)); };
  w.value(std::uint64_t{2}).value(std::uint64_t(count)).value(std::uint64_t{3}).value(tag(0)).line();
  for (const bool second : {false, true}) {
    const std::size_t begin = second ? half : 0, end = second ? count : half;
    w.value(std::int32_t{second ? 3 : 1}).value(std::int32_t{1}).value(std::int32_t{!second});
    w.value(std::uint64_t(end - begin)).line();
    for (std::size_t n = begin; n < end; ++n) w.value(tag(n)).line();
    for (std::size_t n = begin; n < end; ++n) {
      w.point(mesh.first[n]);
      if (!second) w.value(0.5);
      w.line();
    }
  }
  w.text("\n$EndNodes\n$Elements\n");
  w.value(std::uint64_t{2})
      .value(std::uint64_t(tets + 1))
      .value(std::uint64_t{1})
      .value(std::uint64_t(tets + 1))
      .line();
  w.value(std::int32_t{2}).value(std::int32_t{1}).value(std::int32_t{2}).value(std::uint64_t{1}).line();
  w.value(std::uint64_t{1}).value(tag(0)).value(tag(1)).value(tag(2)).line();
  w.value(std::int32_t{3}).value(std::int32_t{1}).value(std::int32_t{4}).value(std::uint64_t(tets)).line();
  for (std::size_t t = 0; t < tets; ++t) {
    w.value(std::uint64_t(t + 2));
    for (const std::uint32_t corner : mesh.second[t]) w.value(tag(corner));
    w.line();
  }
  return w.text("\n$EndElements\n").take();
}

// Binary VTK is big-endian.
inline std::string vtk(const NodesAndTets& mesh, bool binary, bool five) {
  TetWriter w(binary, true);
  w.text(fmt::format("# vtk DataFile Version {}\ntetrahedra\n{}\nDATASET UNSTRUCTURED_GRID\n", five ? "5.1" : "3.0",
                     binary ? "BINARY" : "ASCII"));
  w.text("FIELD FieldData 1\ntime 1 1 double\n").value(0.25).text("\n");
  w.text(fmt::format("POINTS {} double\n", mesh.first.size()));
  for (const dvec3& p : mesh.first) w.point(p).line();
  w.text("\n");
  if (five) w.text("METADATA\nINFORMATION 0\n\n");
  const std::size_t tets = mesh.second.size();
  if (five) {
    w.text(fmt::format("CELLS {} {}\nOFFSETS vtktypeint64\n", tets + 2, 4 * tets + 3)).value(std::int64_t{0});
    w.value(std::int64_t{3});
    for (std::size_t t = 1; t <= tets; ++t) w.value(std::int64_t(3 + 4 * t));
    w.text("\nCONNECTIVITY vtktypeint64\n").value(std::int64_t{0}).value(std::int64_t{1}).value(std::int64_t{2}).line();
    for (const Tet& t : mesh.second)
      for (const std::uint32_t corner : t) w.value(std::int64_t{corner});
  } else {
    w.text(fmt::format("CELLS {} {}\n", tets + 1, 5 * tets + 4));
    w.value(std::int32_t{3}).value(std::int32_t{0}).value(std::int32_t{1}).value(std::int32_t{2}).line();
    for (const Tet& t : mesh.second) {
      w.value(std::int32_t{4});
      for (const std::uint32_t corner : t) w.value(std::int32_t(corner));
      w.line();
    }
  }
  w.text(fmt::format("\nCELL_TYPES {}\n", tets + 1)).value(std::int32_t{5}).line();
  for (std::size_t t = 0; t < tets; ++t) w.value(std::int32_t{10}).line();
  return w.text(fmt::format("\nPOINT_DATA {}\n", mesh.first.size())).take();
}

// .node and .ele.
inline std::pair<std::string, std::string> tetgen(const NodesAndTets& mesh, std::uint32_t first) {
  std::string node = fmt::format("# a comment\n\n{} 3 1 1\n", mesh.first.size());
  for (std::size_t n = 0; n < mesh.first.size(); ++n) {
    const dvec3 p = mesh.first[n];
    node += fmt::format("{} {} {} {} 0.5 1  # trailing\n", n + first, p.x, p.y, p.z);
  }
  std::string ele = fmt::format("{} 4 0\n", mesh.second.size());
  for (std::size_t t = 0; t < mesh.second.size(); ++t) {
    const Tet& c = mesh.second[t];
    ele += fmt::format("{} {} {} {} {}\n", t + first, c[0] + first, c[1] + first, c[2] + first, c[3] + first);
  }
  return {node, ele};
}

}  // namespace pliant::test
