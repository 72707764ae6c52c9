// Reads the appearance from glTF: materials, pictures, lights and cameras, as components.
#pragma once

#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Converts tinygltf's vector; an empty one gives `otherwise`.
template <class Vector>
Vector vector_of(const std::vector<double>& numbers, Vector otherwise) {
  for (int i = 0; !numbers.empty() && i < Vector::length(); ++i)
    otherwise[i] = static_cast<float>(numbers[static_cast<std::size_t>(i)]);
  return otherwise;
}

// By glTF number. Conversion notes are added to the level.
Material material_of(const SourceDocument& document, std::size_t material, Level& level);
std::optional<Light> light_of(const SourceDocument& document, std::size_t node);
std::optional<Camera> camera_of(const SourceDocument& document, std::size_t node, Level& level);
// Decodes every picture into level.images, by glTF number.
Status read_images(const SourceDocument& document, Level& level);

}  // namespace pliant
