#include "content/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace pliant {

namespace {

std::size_t size_of_component(int type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// A component as the number that glTF 2.0, 3.6.2.2 and 2.11 give it.
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

// Where a bufferView's bytes begin, shifted by an offset; null if the buffer is a placeholder.
const std::uint8_t* view_data(const SourceDocument& document, const Json& holder) {
  const Json& view = document.json["bufferViews"][holder["bufferView"].get<std::size_t>()];
  const Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
  if (buffer.empty()) return nullptr;
  return buffer.data() + value_of<std::size_t>(view, "byteOffset", 0) + value_of<std::size_t>(holder, "byteOffset", 0);
}

template <class Out>
std::vector<Out> read(const SourceDocument& document, std::size_t index, bool stored = false) {
  const Json& accessor = document.json["accessors"][index];
  AccessorLayout layout = layout_of(accessor);
  layout.normalized &= !stored;
  const std::size_t width = layout.components();
  std::vector<Out> out(layout.count * width);
  const std::uint8_t* data = accessor.contains("bufferView") ? view_data(document, accessor) : nullptr;
  if (data) {
    const Json& view = document.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t stride = value_of<std::size_t>(view, "byteStride", layout.element_size);
    if (std::is_same_v<Out, float> && layout.component_type == kFloat && stride == layout.element_size)
      std::memcpy(out.data(), data, out.size() * sizeof(Out));
    else
      for (std::size_t i = 0; i < layout.count; ++i) read_element(data + i * stride, layout, &out[i * width]);
  }
  if (accessor.contains("sparse")) {
    const std::vector<std::uint32_t> indices = read_sparse_indices(document, index);
    const std::uint8_t* values = view_data(document, accessor["sparse"]["values"]);
    for (std::size_t i = 0; values && i < indices.size(); ++i)
      if (indices[i] < layout.count) read_element(values + i * layout.element_size, layout, &out[indices[i] * width]);
  }
  return out;
}

}  // namespace

AccessorLayout layout_of(const Json& accessor) {
  AccessorLayout layout;
  const std::string& type = accessor["type"].get_ref<const std::string&>();
  if (type == "SCALAR") layout.rows = layout.columns = 1;
  if (type == "VEC2" || type == "VEC3" || type == "VEC4") {
    layout.rows = static_cast<std::size_t>(type[3] - '0');
    layout.columns = 1;
  }
  if (type == "MAT2" || type == "MAT3" || type == "MAT4")
    layout.rows = layout.columns = static_cast<std::size_t>(type[3] - '0');
  layout.component_type = accessor["componentType"].get<int>();
  layout.component_size = size_of_component(layout.component_type);
  layout.column_size = layout.rows * layout.component_size;
  if (layout.columns > 1) layout.column_size = (layout.column_size + 3) / 4 * 4;
  layout.element_size = layout.columns * layout.column_size;
  layout.last_size =
      layout.element_size == 0 ? 0 : (layout.columns - 1) * layout.column_size + layout.rows * layout.component_size;
  layout.count = accessor["count"].get<std::uint64_t>();
  layout.normalized = value_of(accessor, "normalized", false);
  layout.known = layout.element_size > 0;
  return layout;
}

bool has_data(const SourceDocument& document, std::size_t index) {
  const Json& accessor = document.json["accessors"][index];
  if (accessor.contains("bufferView")) return view_data(document, accessor) != nullptr;
  return accessor.contains("sparse") && view_data(document, accessor["sparse"]["indices"]) != nullptr &&
         view_data(document, accessor["sparse"]["values"]) != nullptr;
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
  const Json& sparse = document.json["accessors"][index]["sparse"];
  const std::uint8_t* data = view_data(document, sparse["indices"]);
  if (!data) return {};
  std::vector<std::uint32_t> indices(sparse["count"].get<std::size_t>());
  const int type = sparse["indices"]["componentType"].get<int>();
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] = component<std::uint32_t>(data + i * size_of_component(type), type, false);
  return indices;
}

}  // namespace pliant
