// The steps of save_level: a Level as a glTF document, compressed, packed into one buffer.
#pragma once

#include "content/gltf/form/gltf_document.h"

namespace pliant {

// A document with everything in the Level except PLIANT extensions, for Levels that were not read from glTF.
Result<SourceDocument> build_document(const Level& level);

// Parts of a Level as a separate document without nodes. References to materials, images and nodes keep the Level's
// numbers; the code that appends the document renumbers them.
struct LevelParts {
  std::size_t first_material = 0, first_image = 0;  // these and all after them
  std::vector<std::size_t> meshes, animations;
};
struct BuiltParts {
  SourceDocument document;
  std::vector<std::int32_t> mesh_number;  // of LevelParts::meshes, -1: no triangles
};
Result<BuiltParts> build_parts(const Level& level, const LevelParts& parts);

// The document of level.source updated with all changes, including PLIANT extensions.
Result<SourceDocument> merge_document(const Level& level);
// Writes the PLIANT extensions of all nodes and of the shown scene. `number`: /nodes/i of every node; `read`: the node
// as read, or nullptr.
void write_extensions(const Level& level, const std::vector<std::int32_t>& number,
                      const std::vector<const LevelNode*>& read, SourceDocument& document);

Json light_json(const Light& light);     // an element of KHR_lights_punctual's lights
Json camera_json(const Camera& camera);  // an element of cameras

// Compresses triangles of every primitive without morph targets with Draco; drops unreferenced data.
Status compress_document(SourceDocument& document, int bits);

// Converts Draco blobs into plain accessors. `all`: also of primitives that compress_document would skip.
Status decompress_document(SourceDocument& document, bool all);
// Removes unreferenced accessors, bufferViews and bytes.
void drop_unused_data(SourceDocument& document);

// Adds to extensionsUsed, and to extensionsRequired if `required`.
void declare_extension(Json& json, const std::string& name, bool required);
// Gives built channels of keys their KHR_animation_pointer, by the number of their node; `json` declares it.
void point_channels(Json& json, Json& animation);
Json transform_json(const LocalTransform& local);  // non-default translation, rotation and scale

// Moves a document's pictures (unless `keep_image_uris`) and buffers into one buffer, /buffers/0, and returns it.
Bytes pack_document(SourceDocument& document, bool keep_image_uris);

// A Level built, packed and written as a .glb file.
Result<Bytes> level_as_glb(const Level& level);

}  // namespace pliant
