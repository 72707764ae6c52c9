// Bones of a hand from the skin of its mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "content/author/hand_bones.h"
#include "content/author/object_frame.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant {
namespace {

struct SkinJoint {
  std::string name, lower;
  dvec3 at;  // [m] world
};

// The words of a digit; joints are ordered by the words of kOrder, or else by their distance from the wrist.
constexpr std::array<std::array<const char*, 2>, 5> kDigits{
    {{"thumb", "thumb"}, {"index", "index"}, {"middle", "middle"}, {"ring", "ring"}, {"little", "pinky"}}};
constexpr std::array<const char*, 5> kOrder{"metacarpal", "proximal", "intermediate", "distal", "tip"};
constexpr double kShortest = 0.002;  // [1] of the hand: a bone

bool has(const SkinJoint& joint, const char* word) {
  return joint.lower.find(word) != std::string::npos;
}

std::size_t order_of(const SkinJoint& joint) {
  std::size_t i = 0;
  while (i < kOrder.size() && !has(joint, kOrder[i])) ++i;
  return i;
}

std::vector<SkinJoint> joints_of(const Level& level, std::int32_t node) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  const Json& json = level.source->json;
  const Json& skin = json["skins"][json["nodes"][static_cast<std::size_t>(it.source)]["skin"].get<std::size_t>()];
  const std::vector<dmat4> world = world_matrices(level.nodes);
  std::vector<SkinJoint> out;
  for (const Json& number : skin["joints"])
    for (std::size_t i = 0; i < level.nodes.size(); ++i) {
      if (level.nodes[i].source != number.get<std::int32_t>()) continue;
      SkinJoint joint{level.nodes[i].name, level.nodes[i].name, dvec3(world[i][3])};
      for (char& c : joint.lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      out.push_back(std::move(joint));
    }
  return out;
}

Result<DigitBones> digit_of(const std::vector<SkinJoint>& joints, std::size_t which, dvec3 wrist, double size,
                            const std::string& where) {
  const auto& words = kDigits[which];
  std::vector<SkinJoint> found;
  for (const SkinJoint& joint : joints)
    if ((has(joint, words[0]) || has(joint, words[1])) && !(which > 0 && has(joint, kOrder[0]))) found.push_back(joint);
  if (found.size() < 4)
    return Error{where,
                 fmt::format("has a skin with {} joints of the {}, and a digit needs four", found.size(), words[0]),
                 "name them as OpenXR does, from the knuckle to the tip"};
  if (found.size() > 5)
    return Error{where, fmt::format("has a skin with {} joints of the {}, as of two hands", found.size(), words[0]),
                 "keep one hand in the file"};
  const bool by_word =
      std::all_of(found.begin(), found.end(), [](const SkinJoint& joint) { return order_of(joint) < kOrder.size(); });
  std::stable_sort(found.begin(), found.end(), [&](const SkinJoint& a, const SkinJoint& b) {
    return by_word ? order_of(a) < order_of(b) : length(a.at - wrist) < length(b.at - wrist);
  });
  found.erase(found.begin(), found.end() - 4);
  DigitBones out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.joint[i] = found[i].at;
    if (i < 3) out.name[i] = found[i].name;
    if (i > 0 && !(length(found[i].at - found[i - 1].at) > kShortest * size))
      return Error{
          where, fmt::format("has the joints `{}` and `{}` of its skin at one place", found[i - 1].name, found[i].name),
          "move one of them"};
  }
  return out;
}

}  // namespace

Result<std::int32_t> skinned_node(const Level& level) {
  std::int32_t best = -1;
  float largest = 0.0f;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene || node.mesh < 0 || level.meshes[static_cast<std::size_t>(node.mesh)].skinned < 0) continue;
    const float size = object_frame(level, static_cast<std::int32_t>(i)).box.diagonal();
    if (size > largest) best = static_cast<std::int32_t>(i), largest = size;
  }
  if (best < 0)
    return Error{level.path.string(), "has no mesh with a skin, so where a hand's bones are is unknown",
                 "take a glTF hand with joints, such as that of WebXR; or leave out --hand"};
  return best;
}

Result<HandBones> bones_of_skin(const Level& level, std::int32_t node) {
  const std::vector<SkinJoint> joints = joints_of(level, node);
  const std::string where = level.nodes[static_cast<std::size_t>(node)].name;
  HandBones out;
  const auto wrist =
      std::find_if(joints.begin(), joints.end(), [](const SkinJoint& joint) { return has(joint, "wrist"); });
  if (wrist == joints.end())
    return Error{where, "has a skin without a joint named `wrist`", "name its joints as OpenXR does"};
  out.wrist = wrist->at;
  double size = 0.0;
  for (const SkinJoint& joint : joints) size = std::max(size, length(joint.at - out.wrist));
  for (std::size_t i = 0; i < out.digit.size(); ++i) {
    Result<DigitBones> digit = digit_of(joints, i, out.wrist, size, where);
    if (!digit) return digit.error();
    out.digit[i] = std::move(*digit);
  }
  const dvec3 along = out.digit[2].joint[0] - out.wrist, across = out.digit[4].joint[0] - out.digit[1].joint[0];
  if (!(length(cross(along, across)) > kShortest * size * size))
    return Error{where, "has a skin whose wrist and knuckles are in one line", "place them as those of a hand"};
  return out;
}

}  // namespace pliant
