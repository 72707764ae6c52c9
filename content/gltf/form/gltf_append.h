// Adds data to a document. Each piece gets its own bufferView and buffer until the document is packed.
#pragma once

#include <fmt/format.h>

#include <cstring>

#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Returns i of /accessors/i. `component`, `target`: glTF's numbers; `width`: components per element.
template <class T>
std::size_t add_accessor(SourceDocument& document, const std::vector<T>& values, int component, std::size_t width,
                         int target) {
  Bytes bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  document.json["bufferViews"].push_back(
      {{"buffer", document.buffers.size()}, {"byteLength", bytes.size()}, {"target", target}});
  document.json["buffers"].push_back({{"byteLength", bytes.size()}});
  document.buffers.push_back(std::move(bytes));
  document.json["accessors"].push_back({{"bufferView", document.json["bufferViews"].size() - 1},
                                        {"componentType", component},
                                        {"count", values.size() / width},
                                        {"type", width == 1 ? "SCALAR" : fmt::format("VEC{}", width)}});
  return document.json["accessors"].size() - 1;
}

}  // namespace pliant
