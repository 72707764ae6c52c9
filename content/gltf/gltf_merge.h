// The steps of merge_document: what a Level says, written into the document that it came from.
#pragma once

#include "content/gltf/gltf_document.h"

namespace pliant {

struct Merge {
  const Level& level;
  SourceDocument document;                                    // becomes the result
  std::vector<std::int32_t> from;                             // Level node -> /nodes/i as read, -1: new
  std::vector<std::int32_t> number;                           // Level node -> /nodes/i now
  std::vector<std::int32_t> node_now;                         // /nodes/i as read -> now, -1: gone
  std::vector<std::int32_t> mesh_now, light_now, camera_now;  // the same
  bool dropped = false;                                       // something went: some data may be without use

  // The node when it was read, or nothing.
  const LevelNode* read(std::size_t node) const {
    return from[node] < 0 ? nullptr : read_by_number[static_cast<std::size_t>(from[node])];
  }
  Json& object(std::size_t node) { return document.json["nodes"][static_cast<std::size_t>(number[node])]; }
  std::vector<const LevelNode*> read_by_number;
};

// In this order: each relies on those before.
Merge merge_nodes(const Level& level);  // numbers, children, transforms
Status merge_meshes(Merge& merge);      // meshes, materials, images, new animations; mesh and skin of every node
void merge_names(Merge& merge);
void merge_lights_and_cameras(Merge& merge);
void merge_scenes(Merge& merge);
void merge_animations(Merge& merge);

// Whether an animation of the Level is one of the document, but for channels of nodes that are gone.
bool is_as_read(const Merge& merge, std::size_t animation);

// Of json[key], only the elements whose number now is not -1, in their order.
void keep_elements(Json& json, const char* key, const std::vector<std::int32_t>& now);
// What keep_elements makes of the numbers of elements that stay.
std::vector<std::int32_t> numbers_of_kept(const std::vector<bool>& stays);

}  // namespace pliant
