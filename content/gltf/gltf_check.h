// The glTF 2.0 specification as checks, in three passes that each rely on the one before: structure (types, ranges,
// references), meaning (hierarchy, accessors, attributes), data (the bytes). Severities follow the Khronos validator.
#pragma once

#include "content/gltf/gltf_document.h"
#include "content/level/finding.h"

namespace pliant {

void check_structure(const Json& json, Findings& findings);
void check_meaning(const Json& json, Findings& findings);
void check_data(const SourceDocument& document, Findings& findings);

bool extension_is_used(const Json& json, const std::string& name);

}  // namespace pliant
