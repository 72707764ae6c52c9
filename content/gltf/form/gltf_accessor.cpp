#include "content/gltf/form/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace pliant {

namespace {

// 0: a type that is not in glTF 2.0; tinygltf accepts two more.
std::size_t size_of_component(int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_INT || type == TINYGLTF_COMPONENT_TYPE_DOUBLE) return 0;
  return static_cast<std::size_t>(std::max(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)), 0));
}

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Converts a component to a number by glTF 2.0, 3.6.2.2 and 2.11.
template <class Out>
Out component(const std::uint8_t* at, int type, bool normalized) {
  const auto scaled = [&](auto value, float scale) {
    return normalized ? static_cast<Out>(std::max(static_cast<float>(value) / scale, -1.0f)) : static_cast<Out>(value);
  };
  switch (type) {
    case kByte:
      return scaled(load<std::int8_t>(at), 127.0f);
    case kUnsignedByte:
      return scaled(*at, 255.0f);
    case kShort:
      return scaled(load<std::int16_t>(at), 32767.0f);
    case kUnsignedShort:
      return scaled(load<std::uint16_t>(at), 65535.0f);
    case kUnsignedInt:
      return static_cast<Out>(load<std::uint32_t>(at));
    default:
      return static_cast<Out>(load<float>(at));
  }
}

template <class Out>
void read_element(const std::uint8_t* at, const AccessorLayout& layout, Out* out) {
  for (std::size_t column = 0; column < layout.columns; ++column)
    for (std::size_t row = 0; row < layout.rows; ++row)
      *out++ = component<Out>(at + column * layout.column_size + row * layout.component_size, layout.component_type,
                              layout.normalized);
}

// The address of a bufferView's bytes plus an offset; null if there is none or its buffer is a placeholder.
const std::uint8_t* view_data(const SourceDocument& document, int number, std::size_t offset) {
  if (number < 0) return nullptr;
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(number)];
  const Bytes& buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
  return buffer.empty() ? nullptr : buffer.data() + view.byteOffset + offset;
}
const std::uint8_t* sparse_indices(const SourceDocument& document, const tinygltf::Accessor& accessor) {
  const auto& at = accessor.sparse.indices;
  return view_data(document, at.bufferView, static_cast<std::uint32_t>(at.byteOffset));
}
const std::uint8_t* sparse_values(const SourceDocument& document, const tinygltf::Accessor& accessor) {
  const auto& at = accessor.sparse.values;
  return view_data(document, at.bufferView, static_cast<std::uint32_t>(at.byteOffset));
}

template <class Out>
std::vector<Out> read(const SourceDocument& document, std::size_t index, bool stored = false) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  AccessorLayout layout = layout_of(accessor);
  layout.normalized &= !stored;
  const std::size_t width = layout.components();
  std::vector<Out> out(layout.count * width);
  if (const std::uint8_t* data = view_data(document, accessor.bufferView, accessor.byteOffset)) {
    const std::size_t given = document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = given == 0 ? layout.element_size : given;
    if (std::is_same_v<Out, float> && layout.component_type == kFloat && stride == layout.element_size)
      std::memcpy(out.data(), data, out.size() * sizeof(Out));
    else
      for (std::size_t i = 0; i < layout.count; ++i) read_element(data + i * stride, layout, &out[i * width]);
  }
  if (accessor.sparse.isSparse) {
    const std::vector<std::uint32_t> indices = read_sparse_indices(document, index);
    const std::uint8_t* values = sparse_values(document, accessor);
    for (std::size_t i = 0; values && i < indices.size(); ++i)
      if (indices[i] < layout.count) read_element(values + i * layout.element_size, layout, &out[indices[i] * width]);
  }
  return out;
}

// A vector is one column.
AccessorLayout make_layout(std::size_t rows, std::size_t columns, int component_type, std::uint64_t count,
                           bool normalized) {
  AccessorLayout layout;
  layout.rows = rows;
  layout.columns = columns;
  layout.component_type = component_type;
  layout.component_size = size_of_component(component_type);
  layout.column_size = rows * layout.component_size;
  if (columns > 1) layout.column_size = (layout.column_size + 3) / 4 * 4;
  layout.element_size = columns * layout.column_size;
  layout.last_size = layout.element_size == 0 ? 0 : (columns - 1) * layout.column_size + rows * layout.component_size;
  layout.count = count;
  layout.normalized = normalized;
  layout.known = layout.element_size > 0;
  return layout;
}

}  // namespace

AccessorLayout layout_of(const Json& accessor) {
  const std::string& type = accessor["type"].get_ref<const std::string&>();
  std::size_t rows = 0, columns = 0;
  if (type == "SCALAR") rows = columns = 1;
  if (type == "VEC2" || type == "VEC3" || type == "VEC4") {
    rows = static_cast<std::size_t>(type[3] - '0');
    columns = 1;
  }
  if (type == "MAT2" || type == "MAT3" || type == "MAT4") rows = columns = static_cast<std::size_t>(type[3] - '0');
  return make_layout(rows, columns, accessor["componentType"].get<int>(), accessor["count"].get<std::uint64_t>(),
                     value_of(accessor, "normalized", false));
}

AccessorLayout layout_of(const tinygltf::Accessor& accessor) {
  // TINYGLTF_TYPE_VEC2 .. VEC4 are 2 .. 4, MAT2 .. MAT4 are 32 + 2 .. 4.
  const int type = accessor.type == TINYGLTF_TYPE_SCALAR ? 1 : accessor.type;
  const bool matrix = type >= TINYGLTF_TYPE_MAT2, known = type > 0;
  const std::size_t rows = known ? static_cast<std::size_t>(type % 32) : 0;
  return make_layout(rows, matrix ? rows : known ? 1 : 0, accessor.componentType, accessor.count, accessor.normalized);
}

bool has_data(const SourceDocument& document, std::size_t index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  if (accessor.bufferView >= 0) return view_data(document, accessor.bufferView, accessor.byteOffset) != nullptr;
  return accessor.sparse.isSparse && sparse_indices(document, accessor) && sparse_values(document, accessor);
}

std::vector<float> read_floats(const SourceDocument& document, std::size_t accessor) {
  return read<float>(document, accessor);
}
std::vector<std::uint32_t> read_integers(const SourceDocument& document, std::size_t accessor) {
  return read<std::uint32_t>(document, accessor);
}

std::vector<double> read_stored(const SourceDocument& document, std::size_t accessor) {
  return read<double>(document, accessor, true);
}

std::vector<std::uint32_t> read_sparse_indices(const SourceDocument& document, std::size_t index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  const std::uint8_t* data = sparse_indices(document, accessor);
  if (!data) return {};
  std::vector<std::uint32_t> indices(static_cast<std::uint32_t>(accessor.sparse.count));
  const int type = accessor.sparse.indices.componentType;
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] = component<std::uint32_t>(data + i * size_of_component(type), type, false);
  return indices;
}

std::vector<std::uint32_t> as_triangles(int mode, std::vector<std::uint32_t> corner) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    corner.resize(corner.size() / 3 * 3);
    return corner;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < corner.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      out.insert(out.end(), {corner[i + 1], corner[i + 2], corner[0]});
    else if (i % 2 == 0)
      out.insert(out.end(), {corner[i], corner[i + 1], corner[i + 2]});
    else
      out.insert(out.end(), {corner[i], corner[i + 2], corner[i + 1]});
  }
  return out;
}

}  // namespace pliant
