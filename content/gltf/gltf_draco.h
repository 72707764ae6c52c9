// Draco-compressed triangles, from and to memory. Blobs are untrusted: what their headers claim is compared with their
// size before the library is let at them in a child process, and what it returns is checked before it is handed on.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

// One attribute per vertex. Integers fit a float exactly up to 2^24.
struct DracoAttribute {
  std::string name;       // glTF semantic; empty where only the id was asked for
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

// The attributes with these unique ids, as floats; integers keep their stored value.
struct DracoBlob {
  std::span<const std::uint8_t> bytes;
  std::vector<std::uint32_t> ids;
};
// All of them in one child, which has `seconds` of processor time beside what their bytes allow it; `used`: where those
// are added that it took. Nothing where one of them is damaged, or they come to more than a child may hand over.
Result<std::vector<DracoMesh>> decode_draco(const std::vector<DracoBlob>& blobs,
                                            double seconds = limits::kReaderTime.most, double* used = nullptr);
Result<DracoMesh> decode_draco(std::span<const std::uint8_t> blob, const std::vector<std::uint32_t>& ids,
                               double seconds = limits::kReaderTime.most, double* used = nullptr);

// A bare .drc file: its attributes come named POSITION, NORMAL and TEXCOORD_0.
Result<DracoMesh> decode_draco_file(std::span<const std::uint8_t> blob);

// Positions are quantised to `bits` (8..24), the rest to as many as keep it below what can be seen. `ids` of the mesh's
// attributes are set to those in the blob; vertices are renumbered by the encoder, and `vertices` becomes their count.
Result<Bytes> encode_draco(DracoMesh& mesh, int bits);

}  // namespace pliant
