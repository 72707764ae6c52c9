// Paths along which effects of the kind guidance pull, for the viewport: read in the background.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "editor/core/editor.h"

namespace pliant {

class GuideLines {
 public:
  using All = std::map<std::string, std::shared_ptr<const std::vector<vec3>>>;  // as SolidOrder::guides
  // Starts to read what is missing; everything again where files have changed, or in another document.
  void update(Editor& editor);
  const All& known() const { return *all_; }

 private:
  std::shared_ptr<All> all_ = std::make_shared<All>();  // null: in progress
  std::uint64_t document_ = ~std::uint64_t{0}, files_read_ = 0;
};

// Corners of a path, at most kMostGuideCorners of them, evenly left out.
inline constexpr std::size_t kMostGuideCorners = 2000;
std::vector<vec3> guide_points(const Path& path);

}  // namespace pliant
