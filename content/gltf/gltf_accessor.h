// The Model's accessors as plain arrays (tinygltf has them, but does not read them): strides, normalised integers,
// sparse overrides and matrix padding resolved. Relies on check_meaning: every range has been checked against its
// buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "content/gltf/gltf_document.h"

namespace pliant {

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
                     kFloat = 5126;

// How an accessor's elements lie in memory.
struct AccessorLayout {
  int component_type = 0;
  std::size_t component_size = 0;     // [byte]
  std::size_t rows = 0, columns = 0;  // a vector is one column
  std::size_t column_size = 0;        // [byte] columns of matrices start at multiples of four
  std::size_t element_size = 0;       // [byte] from one element to the next, if there is no stride
  std::size_t last_size = 0;          // [byte] of an element without the padding behind its last column
  std::uint64_t count = 0;
  bool normalized = false;
  bool known = false;  // false: a type or component type that glTF 2.0 does not have
  std::size_t components() const { return rows * columns; }
};
AccessorLayout layout_of(const Json& accessor);  // for the checks that stand before tinygltf
AccessorLayout layout_of(const tinygltf::Accessor& accessor);

// The largest number of an unsigned type, which is no index.
constexpr std::uint32_t restart_index(int component_type) {
  return component_type == kUnsignedByte ? 0xffu : component_type == kUnsignedShort ? 0xffffu : 0xffffffffu;
}

// Whether the accessor stands for bytes of this file: false for zeros, and where a buffer is a placeholder.
bool has_data(const SourceDocument& document, std::size_t accessor);

// count * components() values. Normalised integers become [0, 1] or [-1, 1], others their value.
std::vector<float> read_floats(const SourceDocument& document, std::size_t accessor);
std::vector<std::uint32_t> read_integers(const SourceDocument& document, std::size_t accessor);
// The same as stored, integers not normalised: what min and max speak of.
std::vector<double> read_stored(const SourceDocument& document, std::size_t accessor);
// The elements that a sparse accessor overrides.
std::vector<std::uint32_t> read_sparse_indices(const SourceDocument& document, std::size_t accessor);

}  // namespace pliant
