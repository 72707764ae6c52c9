// The steps of open_gltf before and between the checks: container, JSON, and the bytes that URIs stand for.
#pragma once

#include <span>

#include "content/gltf/gltf_document.h"

namespace pliant {

struct Container {
  std::span<const std::uint8_t> json, bin;
  std::span<const std::uint8_t> glb;  // the whole file as far as it declares; empty: it is no GLB
  bool has_bin = false;
};

inline void add_error(Findings& findings, std::string pointer, std::string message) {
  findings.push_back({Severity::kError, std::move(pointer), std::move(message)});
}
inline void add_warning(Findings& findings, std::string pointer, std::string message) {
  findings.push_back({Severity::kWarning, std::move(pointer), std::move(message)});
}

// GLB into its chunks; false after an error.
bool split_glb(std::span<const std::uint8_t> file, Container& out, Findings& findings);
// JSON of bounded depth and number of values; false after an error.
bool parse_json(std::span<const std::uint8_t> text, Json& json, Findings& findings);

// What URIs stand for, by glTF number.
struct FetchedBytes {
  std::vector<Bytes> buffers;        // as long as declared; empty: in the BIN chunk, or a placeholder
  std::vector<bool> is_placeholder;  // of buffers: without data
  std::vector<Bytes> images;         // encoded; empty: in a bufferView, or not there
};
// Structure and meaning have been checked.
FetchedBytes fetch_bytes(const SourceDocument& document, const Container& container, Findings& findings);

// Compares document.images with what they claim to be, and drops what is not shown.
void check_pictures(SourceDocument& document, Findings& findings);

}  // namespace pliant
