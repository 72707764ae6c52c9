// Decodes and encodes Draco-compressed triangles in memory. Blobs are untrusted. The counts in their headers are
// checked against their size before the library decodes them in a child process; its results are checked too.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

// One value per vertex. Integers fit a float exactly up to 2^24.
struct DracoAttribute {
  std::string name;       // glTF semantic; empty if requested by id
  std::uint32_t id = 0;   // Draco's unique id
  std::size_t width = 0;  // components
  bool integer = false;   // stored as 16-bit unsigned (JOINTS)
  std::vector<float> values;
};
struct DracoMesh {
  std::size_t vertices = 0;
  std::vector<std::uint32_t> index;  // three per triangle
  std::vector<DracoAttribute> attributes;
};

// Requests the attributes with these unique ids, as floats; integers keep their stored value.
struct DracoBlob {
  std::span<const std::uint8_t> bytes;
  std::vector<std::uint32_t> ids;
};
// Decodes all blobs in one child process. Its CPU time limit is `seconds` plus an allowance for their bytes; `used`:
// the CPU time is added here. Returns nothing if one blob is damaged, or if the result is larger than a child may
// return.
Result<std::vector<DracoMesh>> decode_draco(const std::vector<DracoBlob>& blobs,
                                            double seconds = limits::kReaderTime.most, double* used = nullptr);
Result<DracoMesh> decode_draco(std::span<const std::uint8_t> blob, const std::vector<std::uint32_t>& ids,
                               double seconds = limits::kReaderTime.most, double* used = nullptr);

// A bare .drc file: its attributes are named POSITION, NORMAL and TEXCOORD_0.
Result<DracoMesh> decode_draco_file(std::span<const std::uint8_t> blob);

// Quantises positions to `bits` (8..24), other attributes so that no error is visible. `ids` of the mesh's attributes
// are set to those in the blob. The encoder renumbers vertices; `vertices` becomes their new number.
Result<Bytes> encode_draco(DracoMesh& mesh, int bits);

}  // namespace pliant
