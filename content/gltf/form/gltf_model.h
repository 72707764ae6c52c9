// glTF through tinygltf (Debian's 2.7): a checked document as a tinygltf::Model, a Model as JSON, JSON and bytes as a
// GLB file. tinygltf opens no file and decodes nothing; our own bounded code handles URIs, pictures and Draco data.
#pragma once

#include <optional>

#include "content/gltf/form/gltf_container.h"

namespace pliant {

// Fills document.model, document.buffers and document.images. Requires checked JSON (check_meaning).
void read_model(SourceDocument& document, const Container& container, FetchedBytes fetched, Findings& findings);

// Refills document.model after changes to JSON and buffers.
void reread_model(SourceDocument& document, Findings& findings);

// Replacement JSON where tinygltf cannot read the file's own (cases in gltf_rewrite.cpp); every buffer is then in
// `fetched`. Empty: tinygltf can read the file as it is.
std::optional<Json> rewritten_for_tinygltf(const SourceDocument& document, const Container& container,
                                           FetchedBytes& fetched);
// Restores the rewritten parts in the Model.
void restore_rewritten(const Json& json, tinygltf::Model& model);

// A Model from build_document as tinygltf's JSON, without buffers, with the losses of 2.7 repaired. A document that was
// read is saved from its own JSON, because tinygltf would lose much more of it: extensions and extras of accessors,
// skins and samplers; null, empty and large members; the integer type.
Json model_as_json(const tinygltf::Model& model);
Bytes as_glb(const std::string& json, const Bytes& bin);

}  // namespace pliant
