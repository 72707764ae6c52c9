// The steps of open_gltf before and between the checks: container, JSON, and the bytes that URIs refer to.
#pragma once

#include <span>

#include "content/gltf/form/gltf_document.h"

namespace pliant {

struct Container {
  std::span<const std::uint8_t> json, bin;
  std::span<const std::uint8_t> glb;  // the file up to its declared length; empty: not a GLB
  bool has_bin = false;
};

inline void add_error(Findings& findings, std::string pointer, std::string what, std::string cure = {}) {
  findings.push_back({Severity::kError, std::move(pointer), std::move(what), std::move(cure), "gltf.file"});
}
inline void add_warning(Findings& findings, std::string pointer, std::string what, std::string cure = {}) {
  findings.push_back({Severity::kWarning, std::move(pointer), std::move(what), std::move(cure), "gltf.file"});
}

// Splits a GLB into its chunks; false after an error.
bool split_glb(std::span<const std::uint8_t> file, Container& out, Findings& findings);
// Parses JSON with bounded depth and number of values; false after an error.
bool parse_json(std::span<const std::uint8_t> text, Json& json, Findings& findings);

// The bytes that URIs refer to, by glTF number.
struct FetchedBytes {
  std::vector<Bytes> buffers;        // of the declared length; empty: in the BIN chunk, or a placeholder
  std::vector<bool> is_placeholder;  // per buffer: it has no data
  std::vector<Bytes> images;         // encoded; empty: in a bufferView, or missing
};
// Requires checked structure and meaning.
FetchedBytes fetch_bytes(const SourceDocument& document, const Container& container, Findings& findings);

// Compares document.images with their declared types, and drops unsupported formats.
void check_pictures(SourceDocument& document, Findings& findings);

}  // namespace pliant
