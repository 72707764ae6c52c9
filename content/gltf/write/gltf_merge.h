// The steps of merge_document, which writes a Level into its source document.
#pragma once

#include "content/gltf/form/gltf_document.h"

namespace pliant {

struct Merge {
  const Level& level;
  SourceDocument document;                                    // becomes the result
  std::vector<std::int32_t> from;                             // Level node -> /nodes/i as read, -1: new
  std::vector<std::int32_t> number;                           // Level node -> /nodes/i now
  std::vector<std::int32_t> node_now;                         // /nodes/i as read -> now, -1: gone
  std::vector<std::int32_t> mesh_now, light_now, camera_now;  // the same
  bool dropped = false;                                       // an element was removed: data may be unused

  // The node as read, or nullptr.
  const LevelNode* read(std::size_t node) const {
    return from[node] < 0 ? nullptr : read_by_number[static_cast<std::size_t>(from[node])];
  }
  Json& object(std::size_t node) { return document.json["nodes"][static_cast<std::size_t>(number[node])]; }
  std::vector<const LevelNode*> read_by_number;
};

// In this order: each step relies on the previous ones.
Merge merge_nodes(const Level& level);  // numbers, children, transforms
Status merge_meshes(Merge& merge);      // meshes, materials, images, new animations; mesh and skin of every node
Status merge_materials(Merge& merge);   // changed ones
void merge_names(Merge& merge);
void merge_lights_and_cameras(Merge& merge);
void merge_scenes(Merge& merge);
void merge_animations(Merge& merge);

// Appends the meshes of which `meshes_anew` is set (by Level mesh), and the materials, images and animations that are
// not in the document. `made`: the number of each such mesh in /meshes, else -1.
Status append_parts(Merge& merge, const std::vector<bool>& meshes_anew, std::vector<std::int32_t>& made);

// build_parts numbers textures by their images; afterwards by the document's textures.
void point_textures(Json& document, Json& json);

// Whether the Level's animation equals that of the document, except for channels of removed nodes.
bool is_as_read(const Merge& merge, std::size_t animation);

// Keeps the elements of json[key] whose new number is not -1, in their order.
void keep_elements(Json& json, const char* key, const std::vector<std::int32_t>& now);
// The new numbers of elements after keep_elements.
std::vector<std::int32_t> numbers_of_kept(const std::vector<bool>& stays);

}  // namespace pliant
