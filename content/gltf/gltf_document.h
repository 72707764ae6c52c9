// A glTF file checked and read: its JSON, what tinygltf makes of it, the bytes of its buffers and of its pictures.
// load_level reads from it, save_level writes it back; nothing else knows glTF's containers.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/transform.h"
#include "content/files/file_io.h"
#include "content/gltf/tinygltf.h"
#include "content/level/finding.h"
#include "content/level/level.h"
#include "content/mesh/painted.h"
#include "pliant/content.h"

namespace pliant {

using Json = nlohmann::json;

// A mesh when it was read, as hashes: what has another one has changed since.
struct PrimitiveAsRead {
  std::int32_t source = -1;
  std::uint64_t shape = 0;                               // everything but what is painted
  std::array<std::uint64_t, kPainted.size()> painted{};  // in the order of kPainted
};
struct MeshAsRead {
  std::int32_t source = -1, skinned = -1;  // as LevelMesh has them
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
  Json json;                    // as checked. Extensions and extras are read from here, and saving changes only this
  tinygltf::Model model;        // the same without extensions and extras, as it was read; without bytes
  bool json_is_mended = false;  // not what the file's text says: tinygltf then reads `json` instead
  std::filesystem::path folder;
  std::vector<Bytes> buffers;  // as many as json["buffers"]; empty: a placeholder without data
  std::vector<Bytes> images;   // encoded, as many as json["images"]; empty: not read (a format that is not shown)

  // What load_level made of it, so that save_level writes only what has changed since.
  std::vector<LevelNode> nodes_as_read;  // without meshes: name, transform and extensions
  std::vector<MeshAsRead> meshes_as_read;
  std::vector<std::vector<ChannelAsRead>> animations_as_read;  // by number
  std::optional<SafetyCap> cap;                                // what cap_safety lowered the nodes to since
};

// Opens .gltf or .glb and checks it against the glTF 2.0 specification. Every finding goes to `findings`; the document
// comes back only if none is an error.
std::optional<SourceDocument> open_gltf(const std::filesystem::path& path, Findings& findings);
// The same for a file in memory (`name` is only spoken of); external files are sought in `folder`.
std::optional<SourceDocument> open_gltf(std::span<const std::uint8_t> bytes, bool expect_glb,
                                        const std::filesystem::path& folder, Findings& findings);

// The rest of load_level: the Level of a document that open_gltf let through with these findings.
Result<Level> load_document(SourceDocument document, const Findings& findings, const std::filesystem::path& path);
// The whole of load_level for a file in memory.
Result<Level> load_gltf(std::span<const std::uint8_t> bytes, bool expect_glb, const std::filesystem::path& folder);

// The elements of an object's array member, none if it is absent.
const Json& array_of(const Json& object, const char* key);
// A member, or `otherwise` if it is absent. The document has been checked: the type is right.
template <class T>
T value_of(const Json& object, const char* key, T otherwise) {
  const auto it = object.find(key);
  return it == object.end() ? otherwise : it->template get<T>();
}
// object.extensions[name], or null.
const Json* extension_of(const Json& object, const char* name);
// asset.extras.about, or "": what the level shows, in its maker's words.
std::string about_of(const Json& root);
// A token as part of a JSON pointer.
std::string escaped(const std::string& token);

}  // namespace pliant
