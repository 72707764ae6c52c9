#include "content/gltf/write/gltf_merge_skins.h"

#include <algorithm>
#include <cmath>

#include "content/gltf/form/gltf_accessor.h"

namespace pliant {

SkinsAtRest::SkinsAtRest(const Merge& merge) : merge_(merge) {
  if (!merge.document.json.contains("skins")) return;
  const std::vector<LevelNode>& read = merge.level.source->nodes_as_read;
  then_.resize(read.size());
  now_.resize(read.size());
  const std::vector<dmat4> before = world_matrices(read), after = world_matrices(merge.level.nodes);
  for (std::size_t i = 0; i < read.size(); ++i) then_[static_cast<std::size_t>(read[i].source)] = before[i];
  for (std::size_t i = 0; i < merge.from.size(); ++i)
    if (merge.from[i] >= 0) now_[static_cast<std::size_t>(merge.from[i])] = after[i];
}

bool SkinsAtRest::is(std::int32_t node) const {
  const Json& json = merge_.level.source->json;
  const std::size_t at = static_cast<std::size_t>(node);
  const Json& skin = json["skins"][json["nodes"][at]["skin"].get<std::size_t>()];
  for (const Json& number : skin["joints"]) {
    const std::size_t joint = number.get<std::size_t>();
    if (merge_.node_now[joint] < 0) return false;
    if (now_[joint] == then_[joint] && now_[at] == then_[at]) continue;
    const dmat4 then = glm::inverse(then_[at]) * then_[joint], now = glm::inverse(now_[at]) * now_[joint];
    double largest = 0.0, change = 0.0;
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) {
        largest = std::max(largest, std::abs(then[c][r]));
        change = std::max(change, std::abs(then[c][r] - now[c][r]));
      }
    if (!(change <= 1e-5 * largest)) return false;
  }
  return true;
}

std::vector<std::int32_t> merge_skins(Merge& merge) {
  Json& json = merge.document.json;
  if (!json.contains("skins")) return {};
  std::vector<bool> stays;
  for (Json& skin : json["skins"]) {
    bool whole = true;
    for (Json& joint : skin["joints"]) {
      joint = merge.node_now[joint.get<std::size_t>()];
      whole = whole && joint >= 0;
    }
    if (skin.contains("skeleton")) {
      const std::int32_t root = merge.node_now[skin["skeleton"].get<std::size_t>()];
      if (root >= 0)
        skin["skeleton"] = root;
      else
        skin.erase("skeleton");
    }
    stays.push_back(whole);
  }
  std::vector<std::int32_t> now = numbers_of_kept(stays);
  keep_elements(json, "skins", now);
  return now;
}

}  // namespace pliant
