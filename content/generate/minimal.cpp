#include "content/generate/minimal.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "components/math.h"
#include "content/files/file_io.h"
#include "content/generate/strokes.h"

namespace pliant::generate {
namespace {

constexpr std::uint16_t kSquares = 32;  // per side
constexpr std::uint32_t kVertices = (kSquares + 1) * (kSquares + 1), kIndices = 6 * kSquares * kSquares;
constexpr float kSide = 0.1f;  // [m]

// {0} vertices, {1} indices, {2} bytes of indices, {3} bytes of positions, {4} all bytes, {5} half a side.
constexpr const char* kLevel = R"({{
  "asset": {{
    "version": "2.0",
    "extras": {{
      "about": "The smallest level: a flat sheet that gives way, and one point probe led by a script.",
      "frame": "Metres, Y up. The sheet lies in y = 0 and faces up."
    }}
  }},
  "extensionsUsed": ["PLIANT_deformable", "PLIANT_probe", "PLIANT_haptic_device"],
  "scene": 0,
  "scenes": [{{"nodes": [0, 1]}}],
  "nodes": [
    {{
      "name": "sheet",
      "mesh": 0,
      "extensions": {{"PLIANT_deformable": {{"stiffness": 300, "reach": 0.02}}}},
      "extras": {{"about": "stiffness in N/m: a dent 5 mm deep pushes back with 1.5 N; reach in m: how far the dent spreads"}}
    }},
    {{
      "name": "tip",
      "extensions": {{
        "PLIANT_probe": {{"radius": 0, "device": "tip"}},
        "PLIANT_haptic_device": {{"driver": "script", "file": "minimal.csv"}}
      }},
      "extras": {{"about": "radius 0 is a point; the script says where it is and when"}}
    }}
  ],
  "meshes": [{{"name": "sheet", "primitives": [{{"attributes": {{"POSITION": 1}}, "indices": 0, "material": 0}}]}}],
  "materials": [
    {{
      "name": "rubber",
      "pbrMetallicRoughness": {{"baseColorFactor": [0.6, 0.2, 0.16, 1], "metallicFactor": 0, "roughnessFactor": 0.38}},
      "doubleSided": true
    }}
  ],
  "accessors": [
    {{"bufferView": 0, "componentType": 5123, "count": {1}, "type": "SCALAR"}},
    {{"bufferView": 1, "componentType": 5126, "count": {0}, "type": "VEC3", "min": [-{5}, 0, -{5}], "max": [{5}, 0, {5}]}}
  ],
  "bufferViews": [
    {{"buffer": 0, "byteOffset": 0, "byteLength": {2}, "target": 34963}},
    {{"buffer": 0, "byteOffset": {2}, "byteLength": {3}, "target": 34962}}
  ],
  "buffers": [{{"uri": "minimal.bin", "byteLength": {4}}}]
}}
)";

template <class T>
void append(Bytes& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

Bytes geometry() {
  Bytes bytes;
  const auto index = [](std::uint16_t i, std::uint16_t j) {
    return static_cast<std::uint16_t>(j * (kSquares + 1) + i);
  };
  for (std::uint16_t j = 0; j < kSquares; ++j)
    for (std::uint16_t i = 0; i < kSquares; ++i) {
      const auto i1 = static_cast<std::uint16_t>(i + 1), j1 = static_cast<std::uint16_t>(j + 1);
      for (const std::uint16_t v : {index(i, j), index(i, j1), index(i1, j1), index(i, j), index(i1, j1), index(i1, j)})
        append(bytes, v);
    }
  for (int j = 0; j <= kSquares; ++j)
    for (int i = 0; i <= kSquares; ++i) {
      append(bytes, kSide * (static_cast<float>(i) / kSquares - 0.5f));
      append(bytes, 0.0f);
      append(bytes, kSide * (static_cast<float>(j) / kSquares - 0.5f));
    }
  return bytes;
}

}  // namespace

Status write_minimal(const std::filesystem::path& folder) {
  const std::uint32_t index_bytes = 2 * kIndices, position_bytes = 12 * kVertices;
  const std::string json =
      fmt::format(kLevel, kVertices, kIndices, index_bytes, position_bytes, index_bytes + position_bytes, kSide / 2);
  const Bytes bytes = geometry();
  const Stroke stroke{4.0, 0.0, 0.02, 0.005, 0.2, 1.2, 2.8, 3.8, {{-0.02, 0, 0.01}, {0.02, 0, -0.01}}, {1.2, 2.8}};
  Status saved =
      write_files({{folder / "minimal.bin", bytes},
                   {folder / "minimal.gltf", {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}}});
  if (!saved) return saved;
  return save_script(trace([](dvec3 p) { return p.y; }, stroke), "presses 5 mm deep, slides 45 mm and lifts",
                     folder / "minimal.csv");
}

}  // namespace pliant::generate
