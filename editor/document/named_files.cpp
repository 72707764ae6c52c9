#include "editor/document/named_files.h"

#include <algorithm>

#include "content/files/file_io.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant {

namespace fs = std::filesystem;

std::vector<std::string> named_files(const State& state) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& each : state.nodes) {
    const LevelNode& node = each->node;
    if (node.motion) add(node.motion->script);
    if (node.effect) add(node.effect->path);
    if (node.device) add(node.device->file);
    if (node.soft_body) add(node.soft_body->mesh);
  }
  if (state.environment) add(state.environment->panorama);
  return names;
}

OwnFiles own_files(const State& state) {
  OwnFiles files;
  const auto collect = [&](const char* key, std::vector<std::string>& names) {
    const Json& json = state.rest->source->json;
    if (!json.contains(key)) return;
    for (const Json& each : json[key])
      if (each.contains("uri") && !each["uri"].get_ref<const std::string&>().starts_with("data:"))
        names.push_back(each["uri"].get<std::string>());
  };
  if (!state.rest || !state.rest->source) return files;
  collect("images", files.pictures);
  collect("buffers", files.buffers);
  return files;
}

Result<std::vector<std::string>> bring_named_files(const State& state, const fs::path& from, const fs::path& to) {
  std::vector<std::string> brought;
  std::error_code failed;
  if (fs::equivalent(from.empty() ? "." : from, to.empty() ? "." : to, failed)) return brought;
  for (const std::string& name : named_files(state)) {
    const Result<fs::path> source = confined_path(from, name);
    if (!source || !fs::is_regular_file(*source, failed)) continue;  // the level did not find it before either
    const fs::path target = to / fs::path(name).relative_path().lexically_normal();
    if (fs::exists(target, failed)) continue;
    fs::create_directories(target.parent_path(), failed);
    if (!fs::copy_file(*source, target, failed))
      return Error{
          target.string(),
          "could not be copied from " + source->string() + " (" + failed.message() + "), and the level names it",
          "copy it by hand"};
    brought.push_back(name);
  }
  return brought;
}

}  // namespace pliant
