// A checked and parsed glTF file: its JSON, its tinygltf model, and the bytes of its buffers and pictures. load_level
// reads from it and save_level writes it back. No other code knows glTF's containers.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/transform.h"
#include "content/files/file_io.h"
#include "content/gltf/form/tinygltf.h"
#include "content/level/finding.h"
#include "content/level/level.h"
#include "content/mesh/painted.h"
#include "pliant/content.h"

namespace pliant {

// Code of a finding: the file is sound, and the library that reads its data cannot.
inline constexpr const char* kTinygltfFailed = "gltf.tinygltf";

using Json = nlohmann::json;

// Hashes of a mesh as it was read. A different hash means that the mesh has changed since.
struct PrimitiveAsRead {
  std::int32_t source = -1;
  std::uint64_t shape = 0;                               // everything except painted attributes
  std::array<std::uint64_t, kPainted.size()> painted{};  // in the order of kPainted
};
struct MeshAsRead {
  std::int32_t source = -1, skinned = -1;  // as in LevelMesh
  std::vector<PrimitiveAsRead> primitives;
};
struct ChannelAsRead {
  std::int32_t node = -1;   // /nodes/i
  std::uint64_t track = 0;  // and its property
  bool operator==(const ChannelAsRead&) const = default;
};
MeshAsRead fingerprint(const LevelMesh& mesh);
ChannelAsRead fingerprint(const LevelChannel& channel, std::int32_t node);

struct SourceDocument {
  Json json;                    // as checked. Extensions and extras are read from here, and saving modifies only this
  tinygltf::Model model;        // as read, without extensions, extras and bytes
  bool json_is_mended = false;  // it differs from the file's text: tinygltf then reads `json` instead
  std::filesystem::path folder;
  std::vector<Bytes> buffers;  // parallel to json["buffers"]; empty: a placeholder without data
  std::vector<Bytes> images;   // encoded, parallel to json["images"]; empty: not read (unsupported format)

  // The Level as load_level made it: save_level writes only what has changed since.
  std::vector<LevelNode> nodes_as_read;  // without meshes: name, transform and extensions
  std::vector<MeshAsRead> meshes_as_read;
  std::vector<std::vector<ChannelAsRead>> animations_as_read;  // by number
  std::optional<SafetyCap> cap;                                // the limits to which cap_safety has lowered the nodes
                                                               // since
};

// Opens .gltf or .glb and checks it against the glTF 2.0 specification. All findings go to `findings`. The document is
// returned only if none is an error.
std::optional<SourceDocument> open_gltf(const std::filesystem::path& path, Findings& findings);
// The same for a file in memory. `name` is only used in messages; external files are looked up in `folder`.
std::optional<SourceDocument> open_gltf(std::span<const std::uint8_t> bytes, bool expect_glb,
                                        const std::filesystem::path& folder, Findings& findings);

// The second half of load_level: the Level of a document that open_gltf accepted with these findings.
Result<Level> load_document(SourceDocument document, const Findings& findings, const std::filesystem::path& path);
// All of load_level for a file in memory.
Result<Level> load_gltf(std::span<const std::uint8_t> bytes, bool expect_glb, const std::filesystem::path& folder);

// The elements of an object's array member; empty if it is absent.
const Json& array_of(const Json& object, const char* key);
// A member, or `otherwise` if it is absent. Requires a checked document, so that the type is right.
template <class T>
T value_of(const Json& object, const char* key, T otherwise) {
  const auto it = object.find(key);
  return it == object.end() ? otherwise : it->template get<T>();
}
// object.extensions[name], or null.
const Json* extension_of(const Json& object, const char* name);
// asset.extras.about, or "": the author's description of the level.
std::string about_of(const Json& root);
// Escapes a token for a JSON pointer.
std::string escaped(const std::string& token);

}  // namespace pliant
