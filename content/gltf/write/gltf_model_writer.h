// A glTF model that grows, with all its arrays in one buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_model.h"

namespace pliant {

template <class Vector>
std::vector<double> numbers(const Vector& v) {
  std::vector<double> out;
  for (int i = 0; i < Vector::length(); ++i) out.push_back(static_cast<double>(v[i]));
  return out;
}

class ModelWriter {
 public:
  // Adds an extension with these members. All values are defaults: no extension.
  void extend(tinygltf::ExtensionMap& extensions, const char* name, tinygltf::Value::Object members);

  // Appends an array to the buffer in a new bufferView.
  int add_view(const void* data, std::size_t size, int target);
  // Appends an array with an accessor.
  int add_accessor(const void* data, std::size_t count, std::size_t element, int component, int type, int target);
  template <class T>
  int add_attribute(const std::vector<T>& values, int type) {
    return add_accessor(values.data(), values.size(), sizeof(T), kFloat, type, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
  void set_bounds(int accessor, std::vector<double> low, std::vector<double> high);

  SourceDocument take();

  tinygltf::Model model;

 private:
  Bytes bytes_;
};

void add_material(const Material& material, ModelWriter& writer);
// A primitive without triangles is left out. Errors: attributes of different lengths, a position that is not finite.
Result<tinygltf::Mesh> make_mesh(const LevelMesh& mesh, const std::vector<Material>& materials, ModelWriter& writer);

}  // namespace pliant
