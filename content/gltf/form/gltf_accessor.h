// Reads the Model's accessors into plain arrays (tinygltf only parses them). Resolves strides, normalised integers,
// sparse overrides and matrix padding. Requires check_meaning: every range has been checked against its buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "content/gltf/form/gltf_document.h"

namespace pliant {

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
                     kFloat = 5126;

// Memory layout of an accessor's elements.
struct AccessorLayout {
  int component_type = 0;
  std::size_t component_size = 0;     // [byte]
  std::size_t rows = 0, columns = 0;  // a vector is one column
  std::size_t column_size = 0;        // [byte] columns of matrices start at multiples of four
  std::size_t element_size = 0;       // [byte] stride of tightly packed elements
  std::size_t last_size = 0;          // [byte] of an element without the padding after its last column
  std::uint64_t count = 0;
  bool normalized = false;
  bool known = false;  // false: a type or component type that is not in glTF 2.0
  std::size_t components() const { return rows * columns; }
};
AccessorLayout layout_of(const Json& accessor);  // for checks that run before tinygltf
AccessorLayout layout_of(const tinygltf::Accessor& accessor);

// The largest value of an unsigned type, which is not a valid index.
constexpr std::uint32_t restart_index(int component_type) {
  return component_type == kUnsignedByte ? 0xffu : component_type == kUnsignedShort ? 0xffffu : 0xffffffffu;
}

// Whether the accessor has bytes in this file. False: all zeros, or its buffer is a placeholder.
bool has_data(const SourceDocument& document, std::size_t accessor);

// count * components() values. Normalised integers become [0, 1] or [-1, 1]; others keep their value.
std::vector<float> read_floats(const SourceDocument& document, std::size_t accessor);
std::vector<std::uint32_t> read_integers(const SourceDocument& document, std::size_t accessor);
// Values as stored, integers not normalised: accessor.min and max refer to these.
std::vector<double> read_stored(const SourceDocument& document, std::size_t accessor);
// Indices of the elements that a sparse accessor overrides.
std::vector<std::uint32_t> read_sparse_indices(const SourceDocument& document, std::size_t accessor);

// Converts a primitive's corners into triangles with the winding of the first, by its mode: 4 triangles, 5 a strip, 6 a
// fan (glTF 2.0, 3.7.2.1).
std::vector<std::uint32_t> as_triangles(int mode, std::vector<std::uint32_t> corners);

}  // namespace pliant
