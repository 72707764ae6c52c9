// glTF through tinygltf (Debian's 2.7): a checked document as a tinygltf::Model, a Model as JSON, JSON and bytes as a
// GLB file. tinygltf opens no file and decodes nothing: URIs, pictures and Draco data are for our own bounded code.
#pragma once

#include <optional>

#include "content/gltf/gltf_container.h"

namespace pliant {

// Fills document.model, document.buffers and document.images. The JSON has been checked (check_meaning).
void read_model(SourceDocument& document, const Container& container, FetchedBytes fetched, Findings& findings);

// Fills document.model anew from a document whose JSON and buffers have been changed.
void reread_model(SourceDocument& document, Findings& findings);

// The JSON that tinygltf is to read instead of the file's own, where it cannot read that (gltf_rewrite.cpp says what);
// every buffer is then in `fetched`. Nothing: the file as it is will do.
std::optional<Json> rewritten_for_tinygltf(const SourceDocument& document, const Container& container,
                                           FetchedBytes& fetched);
// Puts back into the Model what was rewritten.
void restore_rewritten(const Json& json, tinygltf::Model& model);

// As tinygltf writes it, without buffers; what 2.7 loses of a Model that build_document made is put back. It would lose
// much more of a document that was read (extensions and extras of accessors, skins and samplers, null, empty and large
// members, integers as such): those are saved from their own JSON.
Json model_as_json(const tinygltf::Model& model);
Bytes as_glb(const std::string& json, const Bytes& bin);

}  // namespace pliant
