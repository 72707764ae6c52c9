// The only translation unit with tinygltf's code: its reader, with our callbacks, and its writers of JSON and GLB
// (which Debian's library does not export).
#include <fstream>  // tinygltf's writer needs it even without file access
#include <utility>
#define TINYGLTF_IMPLEMENTATION
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "content/gltf/form/gltf_model.h"

namespace pliant {

namespace {

// The documents of read_model use only the names "buffer/3" and "image/0"; this returns their bytes.
Bytes* served(const std::string& name, void* user) {
  auto& fetched = *static_cast<FetchedBytes*>(user);
  for (const auto& [prefix, all] : {std::pair{"buffer/", &fetched.buffers}, std::pair{"image/", &fetched.images}})
    if (name.rfind(prefix, 0) == 0) {
      const std::size_t number = std::strtoul(name.c_str() + std::strlen(prefix), nullptr, 10);
      return number < all->size() && !(*all)[number].empty() ? &(*all)[number] : nullptr;
    }
  return nullptr;
}

bool exists(const std::string& name, void* user) {
  return served(name, user) != nullptr;
}
std::string as_it_is(const std::string& name, void*) {
  return name;
}
// Every name is read once, so the bytes are moved.
bool hand_over(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
  Bytes* bytes = served(name, user);
  if (bytes) *out = std::move(*bytes);
  return bytes != nullptr;
}
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  image->as_is = true;
  if (size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// The reader only appends. An element takes up to 3 kB, so reserve instead of doubling.
void reserve(const Json& json, tinygltf::Model& model) {
  model.accessors.reserve(array_of(json, "accessors").size());
  model.bufferViews.reserve(array_of(json, "bufferViews").size());
  model.materials.reserve(array_of(json, "materials").size());
  model.meshes.reserve(array_of(json, "meshes").size());
  model.nodes.reserve(array_of(json, "nodes").size());
}

// Whether every element of the document is in the Model, with the same number.
bool is_complete(const Json& json, const tinygltf::Model& model) {
  const auto same = [](const Json& object, const char* key, const auto& elements) {
    return array_of(object, key).size() == elements.size();
  };
  const Json* extension = extension_of(json, "KHR_lights_punctual");
  const std::size_t lights = extension ? (*extension)["lights"].size() : 0;
  bool complete = same(json, "accessors", model.accessors) && same(json, "animations", model.animations) &&
                  same(json, "buffers", model.buffers) && same(json, "bufferViews", model.bufferViews) &&
                  same(json, "cameras", model.cameras) && same(json, "images", model.images) &&
                  same(json, "materials", model.materials) && same(json, "meshes", model.meshes) &&
                  same(json, "nodes", model.nodes) && same(json, "scenes", model.scenes) &&
                  model.lights.size() == lights && same(json, "skins", model.skins) &&
                  same(json, "textures", model.textures);
  for (std::size_t m = 0; complete && m < model.meshes.size(); ++m)
    complete = same(json["meshes"][m], "primitives", model.meshes[m].primitives);
  for (std::size_t a = 0; complete && a < model.animations.size(); ++a)
    complete = same(json["animations"][a], "channels", model.animations[a].channels) &&
               same(json["animations"][a], "samplers", model.animations[a].samplers);
  return complete;
}

template <class Elements>
void put_names_back(const Elements& elements, const char* key, Json& json) {
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements[i].name.find('\0') != std::string::npos) json[key][i]["name"] = elements[i].name;
}

}  // namespace

void read_model(SourceDocument& document, const Container& container, FetchedBytes fetched, Findings& findings) {
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({&exists, &as_it_is, &hand_over, nullptr, &fetched});
  reader.SetImageLoader(&keep_encoded, nullptr);
  std::string errors, warnings;  // not shown: our checks have reported every fault
  reserve(document.json, document.model);
  bool read = false;
  std::string text;
  if (const std::optional<Json> rewritten = rewritten_for_tinygltf(document, container, fetched))
    text = rewritten->dump();
  if (!text.empty())
    read = reader.LoadASCIIFromString(&document.model, &errors, &warnings, text.data(),
                                      static_cast<unsigned>(text.size()), "");
  else if (!container.glb.empty())
    read = reader.LoadBinaryFromMemory(&document.model, &errors, &warnings, container.glb.data(),
                                       static_cast<unsigned>(container.glb.size()));
  else
    read = reader.LoadASCIIFromString(&document.model, &errors, &warnings,
                                      reinterpret_cast<const char*>(container.json.data()),
                                      static_cast<unsigned>(container.json.size()), "");
  if (!read || !is_complete(document.json, document.model))
    return findings.push_back({Severity::kError, "",
                               "is sound glTF that tinygltf cannot read (" + errors.substr(0, errors.find('\n')) + ")",
                               "export it anew", kTinygltfFailed});
  restore_rewritten(document.json, document.model);
  for (std::size_t i = 0; i < document.model.buffers.size(); ++i)
    document.buffers.push_back(fetched.is_placeholder[i] ? Bytes{} : std::move(document.model.buffers[i].data));
  for (tinygltf::Image& image : document.model.images) document.images.push_back(std::move(image.image));
}

void reread_model(SourceDocument& document, Findings& findings) {
  FetchedBytes fetched;
  fetched.buffers = std::exchange(document.buffers, {});
  for (const Bytes& bytes : fetched.buffers) fetched.is_placeholder.push_back(bytes.empty());
  fetched.images = document.images;
  for (Bytes& bytes : fetched.images)
    if (bytes.empty()) bytes.assign(1, 0);  // unsupported format
  const std::vector<Bytes> images = std::exchange(document.images, {});
  document.model = {};
  document.json_is_mended = true;
  read_model(document, {}, std::move(fetched), findings);
  document.images = images;
}

Json model_as_json(const tinygltf::Model& model) {
  std::ostringstream text;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, false, false);
  Json json = Json::parse(text.str());
  // Restores what tinygltf 2.7 loses: elements without members become null, names end at a NUL, emission below 1e-12 is
  // dropped.
  for (const char* key : {"nodes", "scenes"})
    if (json.contains(key))
      for (Json& element : json[key])
        if (element.is_null()) element = Json::object();
  put_names_back(model.animations, "animations", json);
  put_names_back(model.images, "images", json);
  put_names_back(model.materials, "materials", json);
  put_names_back(model.meshes, "meshes", json);
  put_names_back(model.nodes, "nodes", json);
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    if (const auto& glow = model.materials[i].emissiveFactor;
        std::any_of(glow.begin(), glow.end(), [](double c) { return c != 0.0; }))
      json["materials"][i]["emissiveFactor"] = glow;
  return json;
}

Bytes as_glb(const std::string& json, const Bytes& bin) {
  std::ostringstream out;
  tinygltf::WriteBinaryGltfStream(out, json, bin);
  const std::string whole = std::move(out).str();
  return Bytes(whole.begin(), whole.end());
}

}  // namespace pliant
