// Soft bodies that other runs have made, in a folder: runs of a sweep are processes of their own, and most of them have
// the same tissue. A file each, of the bytes as they lie in memory, named by a hash of everything that goes into making
// it; whatever changes any of that finds nothing and makes its own. Only for one build on one machine at a time: the
// folder goes with the sweep.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "content/level/spawn_soft.h"

namespace pliant {

// Tissue as a node asks for it: what make_soft_parts() reads of the node, and nothing else. What it does not read may
// differ between runs that share a body.
LevelNode only_tissue(const LevelNode& node);
// Of only_tissue(), its mesh (or null), the frame, and the bytes of the tetrahedra file.
std::uint64_t soft_key(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                       const std::filesystem::path& folder);

class SoftStore {
 public:
  static constexpr std::uintmax_t kMost = 256 << 20;  // [byte] of all its files: the ones used longest ago go first

  explicit SoftStore(std::filesystem::path folder, std::uintmax_t most = kMost)
      : folder_(std::move(folder)), most_(most) {}
  // Nothing: it is not there, or not whole.
  std::optional<SoftParts> find(std::uint64_t key) const;
  // A body that cannot be kept (no room, no folder) is left out: whoever needs it next makes it again.
  void keep(std::uint64_t key, const SoftParts& parts) const;

 private:
  std::filesystem::path file_of(std::uint64_t key) const;
  void make_room(std::uintmax_t bytes) const;
  std::filesystem::path folder_;
  std::uintmax_t most_;
};

// Where every level of this process looks soft bodies up and keeps them; empty: nowhere. Set once, by the command line.
void set_soft_store(std::filesystem::path folder);
// make_soft_parts(), through the store where there is one.
Result<SoftParts> find_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const std::filesystem::path& folder);

std::vector<std::uint8_t> bytes_of(const SoftParts& parts);
// Nothing: they are cut short, or of something else.
std::optional<SoftParts> soft_parts_of(const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
