// The glTF 2.0 specification as checks, in passes that each rely on the one before: structure (types, ranges,
// references), meaning (hierarchy, accessors, attributes), cost (what reading takes), data (the
// bytes). Severities follow the Khronos validator.
#pragma once

#include "content/gltf/gltf_document.h"
#include "content/level/finding.h"

namespace pliant {

// Writes integers that stand as 1.0 as 1; true: there were some.
bool check_structure(Json& json, Findings& findings);
void check_meaning(const Json& json, Findings& findings);
// That reading the document takes no more than limits::kDecoded beyond a multiple of what its buffers hold.
void check_cost(const SourceDocument& document, Findings& findings);
// True: normals or tangents have length zero, and mend_directions has something to do.
bool check_data(const SourceDocument& document, Findings& findings);

// How many corners Draco data may have of a primitive that declares so many: closed surfaces have six a vertex.
std::uint64_t most_draco_corners(std::uint64_t declared, std::uint64_t vertices);

bool extension_is_used(const Json& json, const std::string& name);

}  // namespace pliant
