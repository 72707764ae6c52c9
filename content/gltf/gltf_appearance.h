// How glTF says that things look: materials, pictures, lights and cameras, as components.
#pragma once

#include "content/gltf/gltf_document.h"

namespace pliant {

// A vector member, or `otherwise` if it is absent.
template <class Vector>
Vector vector_of(const Json& object, const char* key, Vector otherwise) {
  const auto it = object.find(key);
  if (it == object.end()) return otherwise;
  for (int i = 0; i < Vector::length(); ++i) otherwise[i] = (*it)[static_cast<std::size_t>(i)].get<float>();
  return otherwise;
}

// Notes of what is read differently go to the level.
Material material_of(const SourceDocument& document, const Json& json, Level& level);
std::optional<Light> light_of(const SourceDocument& document, const Json& node);
std::optional<Camera> camera_of(const SourceDocument& document, const Json& node, Level& level);
// Decodes every picture into level.images, by glTF number.
Status read_images(const SourceDocument& document, Level& level);

}  // namespace pliant
