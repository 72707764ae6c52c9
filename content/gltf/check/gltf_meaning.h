// Shared by the checks of meaning: the list of findings, and the use of each bufferView and accessor.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "content/gltf/check/finding_list.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Times and values of animations may share a bufferView, but not an accessor.
enum class BufferUse { kVertices, kIndices, kMatrices, kImage, kTimes, kValues };

class Meaning : public FindingList {
 public:
  Meaning(const Json& json, Findings& findings) : FindingList(findings), json_(json) {}
  // Records this use of an accessor and its bufferView; an error if another use was recorded before.
  void use(std::size_t accessor, BufferUse use, const std::string& pointer);
  void use_view(std::size_t view, BufferUse use, const std::string& pointer);

 private:
  const Json& json_;
  std::map<std::size_t, BufferUse> accessor_use_, view_use_;
};

// `parent`: of every node, -1 for roots. A scene that shows a skin must contain its joints, and they must be below its
// skeleton.
void check_skeletons(const Json& json, const std::vector<std::int32_t>& parent, Meaning& check);
void check_images(const Json& json, Meaning& check);
void check_cameras(const Json& json, Meaning& check);
void check_lights_and_variants(const Json& json, Meaning& check);
void check_meshes(const Json& json, Meaning& check);
void check_animations(const Json& json, Meaning& check);

}  // namespace pliant
