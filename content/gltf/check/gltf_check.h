// Checks a document against the glTF 2.0 specification, in passes that rely on the previous one: structure (types,
// ranges, references), meaning (hierarchy, accessors, attributes), cost (memory and time to read), data (the bytes).
// Severities follow the Khronos validator.
#pragma once

#include "content/gltf/form/gltf_document.h"
#include "content/level/finding.h"

namespace pliant {

// Rewrites integers such as 1.0 as 1. Returns true if there were any.
bool check_structure(Json& json, Findings& findings);
void check_meaning(const Json& json, Findings& findings);
// Checks that reading needs at most limits::kDecoded bytes beyond a multiple of the size of the buffers.
void check_cost(const SourceDocument& document, Findings& findings);
// Returns true if normals or tangents have length zero, so that mend_directions is needed.
bool check_data(const SourceDocument& document, Findings& findings);

// The largest number of corners accepted from Draco data, given the declared number: closed surfaces have six per
// vertex.
std::uint64_t most_draco_corners(std::uint64_t declared, std::uint64_t vertices);

bool extension_is_used(const Json& json, const std::string& name);

}  // namespace pliant
