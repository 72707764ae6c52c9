// The steps of save_level: a Level as a glTF document, compressed, packed into one buffer.
#pragma once

#include "content/gltf/gltf_document.h"

namespace pliant {

// A document with everything that a Level says, for Levels that did not come from glTF.
Result<SourceDocument> build_document(const Level& level);

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
