#include "content/gltf/write/gltf_model_writer.h"

#include <algorithm>

namespace pliant {

void ModelWriter::extend(tinygltf::ExtensionMap& extensions, const char* name, tinygltf::Value::Object members) {
  if (members.empty()) return;
  extensions[name] = tinygltf::Value(std::move(members));
  std::vector<std::string>& used = model.extensionsUsed;
  if (std::find(used.begin(), used.end(), name) == used.end()) used.emplace_back(name);
}

int ModelWriter::add_view(const void* data, std::size_t size, int target) {
  bytes_.resize((bytes_.size() + 7) / 8 * 8);
  const auto* begin = static_cast<const std::uint8_t*>(data);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes_.size();
  view.byteLength = size;
  view.target = target;
  bytes_.insert(bytes_.end(), begin, begin + size);
  model.bufferViews.push_back(std::move(view));
  return static_cast<int>(model.bufferViews.size() - 1);
}

int ModelWriter::add_accessor(const void* data, std::size_t count, std::size_t element, int component, int type,
                              int target) {
  tinygltf::Accessor accessor;
  accessor.bufferView = add_view(data, count * element, target);
  accessor.componentType = component;
  accessor.count = count;
  accessor.type = type;
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size() - 1);
}

void ModelWriter::set_bounds(int accessor, std::vector<double> low, std::vector<double> high) {
  model.accessors[static_cast<std::size_t>(accessor)].minValues = std::move(low);
  model.accessors[static_cast<std::size_t>(accessor)].maxValues = std::move(high);
}

SourceDocument ModelWriter::take() {
  SourceDocument out;
  out.json = model_as_json(model);
  if (!bytes_.empty()) {
    out.json["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    out.buffers.push_back(std::move(bytes_));
  }
  out.images.resize(model.images.size());  // stored in the buffer
  out.model = std::move(model);
  return out;
}

}  // namespace pliant
