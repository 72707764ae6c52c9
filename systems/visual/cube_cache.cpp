// Filtered surroundings on disk: a header, then the values of the cube. The file name is the panorama's hash.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "runtime/hash.h"
#include "systems/visual/cube.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kVersion = 2;  // increase it whenever filtered_cube gives different values
constexpr std::uint32_t kLargestCachedFace = 4096;

struct Header {
  std::array<char, 8> magic{'P', 'L', 'I', 'A', 'N', 'T', 'C', 'B'};
  std::uint32_t version = kVersion;
  std::uint32_t face = 0;
  std::uint64_t panorama = 0;  // hash of the filtered panorama
  std::uint64_t content = 0;   // hash of the values that follow
};
static_assert(sizeof(Header) == 32);

std::uint64_t hash_of(const Panorama& panorama) {
  Hash hash;
  hash.add(panorama.width);
  hash.add(panorama.height);
  hash.add(std::span<const float>(panorama.rgb));
  return hash.value();
}

std::uint64_t hash_of(const std::vector<std::uint16_t>& numbers) {
  Hash hash;
  hash.add(std::span<const std::uint16_t>(numbers));
  return hash.value();
}

// Empty: there is no cache folder.
fs::path cache_folder() {
  const char* chosen = std::getenv("XDG_CACHE_HOME");
  if (chosen && *chosen == '/') return fs::path(chosen) / "pliant";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".cache" / "pliant" : fs::path();
}

std::optional<Cube> read_cube(const fs::path& path, std::uint64_t panorama) {
  std::ifstream file(path, std::ios::binary);
  Header header;
  const Header expected;
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
  if (header.magic != expected.magic || header.version != kVersion || header.panorama != panorama) return std::nullopt;
  if (!std::has_single_bit(header.face) || header.face >> (kCubeLevels - 1) == 0 || header.face > kLargestCachedFace)
    return std::nullopt;
  std::error_code failed;
  const std::size_t count = cube_size(header.face);
  if (fs::file_size(path, failed) != sizeof header + count * sizeof(std::uint16_t) || failed) return std::nullopt;
  Cube cube{header.face, std::vector<std::uint16_t>(count)};
  if (!file.read(reinterpret_cast<char*>(cube.rgb.data()), static_cast<std::streamsize>(count * sizeof(std::uint16_t))))
    return std::nullopt;
  if (hash_of(cube.rgb) != header.content) return std::nullopt;
  return cube;
}

// Written to a temporary file and renamed, so that another process never reads an incomplete file.
void write_cube(const fs::path& path, const Cube& cube, std::uint64_t panorama) {
  std::error_code failed;
  fs::create_directories(path.parent_path(), failed);
  fs::path aside = path;
  aside += fmt::format(".{}.part", getpid());
  Header header;
  header.face = cube.face;
  header.panorama = panorama;
  header.content = hash_of(cube.rgb);
  std::ofstream file(aside, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(reinterpret_cast<const char*>(cube.rgb.data()),
             static_cast<std::streamsize>(cube.rgb.size() * sizeof(std::uint16_t)));
  file.close();
  if (file) fs::rename(aside, path, failed);
  if (!file || failed) fs::remove(aside, failed);
}

}  // namespace

Cube cached_cube(const Panorama& panorama) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return filtered_cube(panorama);
  const std::uint64_t name = hash_of(panorama);
  const fs::path path = folder / fmt::format("surroundings-{:016x}.cube", name);
  if (std::optional<Cube> known = read_cube(path, name)) return *std::move(known);
  Cube made = filtered_cube(panorama);
  write_cube(path, made, name);
  return made;
}

}  // namespace pliant
