// The steps of save_level: a Level as a glTF document, compressed, packed into one buffer.
#pragma once

#include "content/gltf/gltf_document.h"

namespace pliant {

// A document with everything that a Level says but PLIANT extensions, for Levels that did not come from glTF.
Result<SourceDocument> build_document(const Level& level);

// Some parts of a Level as a document of their own, without nodes. Materials, images and nodes that they refer to keep
// the Level's numbers: who appends the document to another one knows what they are there.
struct LevelParts {
  std::size_t first_material = 0, first_image = 0;  // these and all behind them
  std::vector<std::size_t> meshes, animations;
};
struct BuiltParts {
  SourceDocument document;
  std::vector<std::int32_t> mesh_number;  // of LevelParts::meshes, -1: no triangles
};
Result<BuiltParts> build_parts(const Level& level, const LevelParts& parts);

// The document of level.source with all that has changed since, PLIANT extensions included.
Result<SourceDocument> merge_document(const Level& level);
// PLIANT extensions of all nodes and of the scene that is shown. `number`: /nodes/i of every node; `read`: what it was
// when the document was read, or nothing.
void write_extensions(const Level& level, const std::vector<std::int32_t>& number,
                      const std::vector<const LevelNode*>& read, SourceDocument& document);

Json light_json(const Light& light);     // an element of KHR_lights_punctual's lights
Json camera_json(const Camera& camera);  // an element of cameras

// Triangles of every primitive without morph targets go into Draco blobs; what nothing refers to any more is dropped.
Status compress_document(SourceDocument& document, int bits);

// The opposite: Draco blobs become plain accessors. `all`: also of primitives that compress_document would leave out.
Status decompress_document(SourceDocument& document, bool all);
// Drops accessors, bufferViews and bytes that nothing refers to.
void drop_unused_data(SourceDocument& document);

// Adds to extensionsUsed, and to extensionsRequired if `required`.
void declare_extension(Json& json, const std::string& name, bool required);
Json transform_json(const LocalTransform& local);  // translation, rotation, scale where they are not the default

// Moves a document's pictures (unless `keep_image_uris`) and buffers into one; returns it. /buffers/0 then stands for
// it.
Bytes pack_document(SourceDocument& document, bool keep_image_uris);

// A Level built, packed and wrapped as a .glb file.
Result<Bytes> level_as_glb(const Level& level);

}  // namespace pliant
