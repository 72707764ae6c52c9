// Reads an OpenEXR file's header before the library does, because the library allocates the sizes that attributes
// claim.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "runtime/result.h"

namespace pliant {

struct ExrHeader {
  std::int64_t width = 0, height = 0;            // [px] of the data window
  std::map<std::string, std::int32_t> channels;  // name -> bytes per sample
  bool deep = false;
};

// The first part's header. Errors: attributes beyond the end of the file, an empty or too large window.
Result<ExrHeader> read_exr_header(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace pliant
