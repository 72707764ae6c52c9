// The glTF 2.0 specification as checks, in three passes that each rely on the one before: structure (types, ranges,
// references), meaning (hierarchy, accessors, attributes), data (the bytes). Severities follow the Khronos validator.
#pragma once

#include "content/gltf/gltf_document.h"
#include "content/level/finding.h"

namespace pliant {

// Writes integers that stand as 1.0 as 1; true: there were some.
bool check_structure(Json& json, Findings& findings);
void check_meaning(const Json& json, Findings& findings);
// True: normals or tangents have length zero, and mend_directions has something to do.
bool check_data(const SourceDocument& document, Findings& findings);

bool extension_is_used(const Json& json, const std::string& name);

}  // namespace pliant
