// Adds up the memory needed to read a document before the first accessor is read. Accessors may share bytes;
// primitives, weight sets and skins may share accessors. A small file could otherwise exhaust the memory or take hours.
#include <fmt/format.h>

#include <algorithm>

#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_accessor.h"

namespace pliant {

namespace {

// Bytes in memory per byte of a usual file: accessors as floats; meshes in the level.
constexpr double kAccessorBytes = 16.0, kMeshBytes = 64.0;
// [byte] Per mesh vertex; per corner (of a strip); per set of joints and weights; per joint, its matrices.
constexpr double kVertex = 64.0, kCorner = 16.0, kWeights = 32.0, kJoint = 64.0;

class Cost {
 public:
  Cost(const SourceDocument& document, Findings& findings) : document_(document), findings_(findings) {
    for (const Bytes& buffer : document.buffers) stored_ += static_cast<double>(buffer.size());
  }

  // Every accessor is read once by the checks.
  bool accessors() {
    double sum = 0.0;
    for (std::size_t i = 0; i < document_.model.accessors.size(); ++i) {
      if (has_data(document_, i)) sum += count(i) * width(i) * 4.0;
      if (!within(sum - kAccessorBytes * stored_, fmt::format("/accessors/{}", i), "brings the document to "))
        return false;
    }
    return true;
  }

  // Every mesh is read once, and once more for each node with a skin.
  void meshes() {
    std::vector<double> cost;
    double sum = 0.0;
    const auto affordable = [&](const std::string& pointer) {
      return within(sum - kMeshBytes * stored_, pointer, "makes the level decode to ");
    };
    for (std::size_t m = 0; m < document_.model.meshes.size(); ++m) {
      const double before = sum;
      for (std::size_t p = 0; p < document_.model.meshes[m].primitives.size(); ++p) {
        sum += primitive(m, p);
        if (!affordable(fmt::format("/meshes/{}/primitives/{}", m, p))) return;
      }
      cost.push_back(sum - before);
    }
    for (std::size_t n = 0; n < document_.model.nodes.size(); ++n) {
      const tinygltf::Node& node = document_.model.nodes[n];
      if (node.skin < 0 || node.mesh < 0) continue;
      const tinygltf::Skin& skin = document_.model.skins[static_cast<std::size_t>(node.skin)];
      double joints = static_cast<double>(skin.joints.size());
      if (skin.inverseBindMatrices >= 0)
        joints = std::max(joints, count(static_cast<std::size_t>(skin.inverseBindMatrices)));
      sum += cost[static_cast<std::size_t>(node.mesh)] + joints * kJoint;
      if (!affordable(fmt::format("/nodes/{}", n))) return;
    }
  }

 private:
  double count(std::size_t accessor) const { return static_cast<double>(document_.model.accessors[accessor].count); }
  double width(std::size_t accessor) const {
    return static_cast<double>(layout_of(document_.model.accessors[accessor]).components());
  }

  // `beyond_the_multiple` [byte]: needed beyond the multiple of the buffers' size.
  bool within(double beyond_the_multiple, const std::string& pointer, const char* what) {
    if (beyond_the_multiple <= static_cast<double>(most(limits::kDecoded))) return true;
    findings_.push_back(
        finding_of(beyond(what, limits::kDecoded, beyond_the_multiple, "split the level"), Severity::kError, pointer));
    return false;
  }

  double primitive(std::size_t mesh, std::size_t number) const {
    const tinygltf::Primitive& primitive = document_.model.meshes[mesh].primitives[number];
    const auto position = primitive.attributes.find("POSITION");
    const bool shown = position != primitive.attributes.end();
    double vertices = 0.0, sets = 0.0, widths = 0.0;
    for (const auto& [name, index] : primitive.attributes) {
      const std::size_t accessor = static_cast<std::size_t>(index);
      vertices = count(accessor);  // equal for all attributes
      widths += width(accessor);
      sets += name.rfind("WEIGHTS_", 0) == 0;
    }
    double corners = primitive.indices < 0 ? vertices : count(static_cast<std::size_t>(primitive.indices));
    const Json& json = document_.json["meshes"][mesh]["primitives"][number];
    if (extension_of(json, "KHR_draco_mesh_compression"))
      return vertices * widths * 4.0 + static_cast<double>(most_draco_corners(static_cast<std::uint64_t>(corners),
                                                                              static_cast<std::uint64_t>(vertices))) *
                                           4.0;
    const bool placeholder = shown &&
                             document_.model.accessors[static_cast<std::size_t>(position->second)].bufferView >= 0 &&
                             !has_data(document_, static_cast<std::size_t>(position->second));
    if (placeholder) return sets * vertices * kWeights;
    return vertices * (kVertex + sets * kWeights) + corners * kCorner;
  }

  const SourceDocument& document_;
  Findings& findings_;
  double stored_ = 0.0;  // [byte] size of the buffers; placeholders have none
};

}  // namespace

std::uint64_t most_draco_corners(std::uint64_t declared, std::uint64_t vertices) {
  return std::max(declared, 6 * vertices);
}

void check_cost(const SourceDocument& document, Findings& findings) {
  Cost cost(document, findings);
  if (cost.accessors()) cost.meshes();
}

}  // namespace pliant
