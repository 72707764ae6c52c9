// The steps of open_gltf before and between the checks: container, JSON, and the bytes that URIs stand for.
#pragma once

#include <span>

#include "content/gltf/gltf_document.h"

namespace pliant {

struct Container {
  std::span<const std::uint8_t> json, bin;
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

// Fill document.buffers and document.images; structure and meaning have been checked.
void resolve_buffers(SourceDocument& document, const Container& container, Findings& findings);
void resolve_images(SourceDocument& document, Findings& findings);

}  // namespace pliant
