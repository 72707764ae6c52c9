// Small glTF documents written in code, loaded from memory.
#pragma once

#include <string>
#include <vector>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant::test {

struct Gltf {
  Json json = {{"asset", {{"version", "2.0"}}}};
  Bytes bin;

  // Appends an array in its own bufferView, at a multiple of four bytes; returns its number.
  template <class T>
  std::size_t view(const std::vector<T>& values) {
    bin.resize((bin.size() + 3) / 4 * 4);
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}});
    bin.insert(bin.end(), begin, begin + values.size() * sizeof(T));
    return json["bufferViews"].size() - 1;
  }
  // The same with an accessor. Bounds are set as glTF requires for POSITION.
  template <class T>
  std::size_t accessor(const std::vector<T>& values, const char* type, int component, bool bounds = false) {
    Json accessor = {{"bufferView", view(values)}, {"componentType", component}, {"type", type}};
    const std::size_t width = type[0] == 'S' ? 1 : type[0] == 'M' ? 16 : static_cast<std::size_t>(type[3] - '0');
    accessor["count"] = values.size() / width;
    for (std::size_t c = 0; bounds && c < width; ++c) {
      T low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += width)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      accessor["min"].push_back(low);
      accessor["max"].push_back(high);
    }
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
  }
  std::size_t positions(const std::vector<float>& values) { return accessor(values, "VEC3", kFloat, true); }
  // One mesh with one primitive, and a node that shows it.
  Json& primitive(Json attributes) {
    json["meshes"].push_back({{"primitives", Json::array({{{"attributes", attributes}}})}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}, {"name", "thing"}});
    return json["meshes"].back()["primitives"][0];
  }

  Bytes glb() const {
    Json whole = json;
    if (!bin.empty()) whole["buffers"] = Json::array({{{"byteLength", bin.size()}}});
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Bytes padded = bin;
    padded.resize((padded.size() + 3) / 4 * 4);
    Bytes out;
    const auto number = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    number(0x46546c67), number(2), number(12 + 8 + text.size() + (padded.empty() ? 0 : 8 + padded.size()));
    number(text.size()), number(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    if (!padded.empty()) {
      number(padded.size()), number(0x004e4942);
      out.insert(out.end(), padded.begin(), padded.end());
    }
    return out;
  }
  Result<Level> load() const {
    const Bytes bytes = glb();
    return load_gltf(bytes, true, {});
  }
  // The error sentence, or "" if it loads.
  std::string refusal() const {
    const Result<Level> level = load();
    return level ? "" : level.error().message();
  }
};

// Two triangles in the plane z = 0, as a list of four corners.
inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

}  // namespace pliant::test
