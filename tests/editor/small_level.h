// A level of a sheet and a probe, and a folder of one's own for a test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "content/level_file.h"
#include "editor/document/document.h"

namespace pliant::testing {

inline Primitive quad_sheet(std::size_t n) {
  Primitive p;
  for (std::size_t y = 0; y <= n; ++y)
    for (std::size_t x = 0; x <= n; ++x)
      p.position.push_back({0.1f * static_cast<float>(x) / static_cast<float>(n), 0.0f,
                            0.1f * static_cast<float>(y) / static_cast<float>(n)});
  const auto at = [&](std::size_t x, std::size_t y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x)
      p.index.insert(p.index.end(),
                     {at(x, y), at(x, y + 1), at(x + 1, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
  return p;
}

inline Level sheet_and_finger() {
  Level level;
  level.name = "small";
  level.meshes.push_back({"sheet", {quad_sheet(20)}});
  LevelNode sheet;
  sheet.name = "sheet";
  sheet.mesh = 0;
  sheet.deformable.emplace();
  LevelNode finger;
  finger.name = "finger";
  finger.probe.emplace();
  finger.device.emplace();
  finger.device->driver = DriverKind::kMouse;
  finger.probe_device = "finger";
  finger.local.translation = {0.05f, 0.05f, 0.05f};
  level.nodes = {sheet, finger};
  return level;
}

struct OwnFolder {
  std::filesystem::path path;
  explicit OwnFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("pliant_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~OwnFolder() { std::filesystem::remove_all(path); }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
};

inline NodeId id_of(const Document& document, const std::string& name) {
  const DocumentNode* const node = document.state().find(name);
  return node ? node->id : kNoNode;
}

}  // namespace pliant::testing
