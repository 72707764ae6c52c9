#include "content/gltf/read/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "content/gltf/form/gltf_accessor.h"
#include "content/keys/extension_table.h"
#include "content/level/varying_keys.h"

namespace pliant {
namespace {

std::optional<NodeProperty> property_of(const std::string& path) {
  if (path == "translation") return NodeProperty::kTranslation;
  if (path == "rotation") return NodeProperty::kRotation;
  if (path == "scale") return NodeProperty::kScale;
  return {};
}

Interpolation interpolation_of(const tinygltf::AnimationSampler& sampler) {
  if (sampler.interpolation == "STEP") return Interpolation::kStep;
  return sampler.interpolation == "CUBICSPLINE" ? Interpolation::kCubicSpline : Interpolation::kLinear;
}

class AnimationReader {
 public:
  AnimationReader(const SourceDocument& document, Level& level) : document_(document), level_(level) {
    node_of_.assign(document.model.nodes.size(), -1);
    for (std::size_t i = 0; i < level.nodes.size(); ++i)
      node_of_[static_cast<std::size_t>(level.nodes[i].source)] = static_cast<std::int32_t>(i);
  }

  Status animation(const tinygltf::Animation& animation, std::size_t number) {
    LevelAnimation out;
    out.name = animation.name;
    out.source = static_cast<std::int32_t>(number);
    for (std::size_t c = 0; c < animation.channels.size(); ++c)
      if (Status s = channel(animation, c, fmt::format("/animations/{}/channels/{}", number, c), out); !s) return s;
    for (LevelChannel& channel : out.channels) channel.track.length = out.length;
    level_.animations.push_back(std::move(out));
    return Done{};
  }

  void say_other() {
    if (other_pointers_ == 0) return;
    std::vector<std::string> keys;
    for (const VaryingKey& each : varying_keys())
      if (!each.of_joint()) keys.emplace_back(each.key);
    const std::string more = other_pointers_ == 1 ? ""
                                                  : fmt::format(" and {} more pointer{}", other_pointers_ - 1,
                                                                other_pointers_ == 2 ? "" : "s");
    level_.notes.push_back(
        fmt::format("the animation pointer {}{} not played; a pointer may vary {} of PLIANT_deformable, and rest of "
                    "PLIANT_joint",
                    other_, more + (other_pointers_ == 1 ? " is" : " are"), listed(keys)));
  }

 private:
  Status channel(const tinygltf::Animation& animation, std::size_t number, const std::string& pointer,
                 LevelAnimation& out) {
    const tinygltf::AnimationChannel& from = animation.channels[number];
    std::optional<NodeProperty> property = property_of(from.target_path);
    std::int64_t node = from.target_node;
    std::string key;
    if (const Json* aims = extension_of(target_of(out, number), "KHR_animation_pointer")) {
      const std::string aim = (*aims)["pointer"].get<std::string>();
      const KeyPointer found = key_pointer(aim);
      if (!find_varying_key(found.key)) {
        note_other(pointer, aim);
        return Done{};
      }
      if (Status s = check_node(pointer, found); !s) return s;
      property = NodeProperty::kKey;
      node = found.node;
      key = found.key;
    }
    if (!property) {
      level_.notes.emplace_back("animations move nodes; morph weights and what else they animate stay as they are");
      return Done{};
    }
    if (node < 0) return Done{};  // glTF 2.0: ignore the channel
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(from.sampler)];
    const std::size_t input = static_cast<std::size_t>(sampler.input),
                      output = static_cast<std::size_t>(sampler.output);
    if (!has_data(document_, input) || !has_data(document_, output)) {
      level_.notes.push_back(pointer + ": is left out: its times or values have no data in this file");
      return Done{};
    }
    keys_ += std::max(document_.model.accessors[input].count, document_.model.accessors[output].count);
    if (keys_ > most(limits::kKeys))
      return error_at(pointer, beyond("brings the level to", limits::kKeys, static_cast<double>(keys_),
                                      "sample its animations more coarsely"));
    LevelChannel channel{node_of_[static_cast<std::size_t>(node)], *property, {}, key};
    channel.track.interpolation = interpolation_of(sampler);
    if (const std::string fault = fill(channel, read_floats(document_, input), read_floats(document_, output));
        !fault.empty())
      return Error{pointer, fault};
    out.length = std::max(out.length, channel.track.times.back());
    out.channels.push_back(std::move(channel));
    return Done{};
  }

  // The channel's target in the document, which has all extensions.
  const Json& target_of(const LevelAnimation& animation, std::size_t channel) const {
    return document_.json["animations"][static_cast<std::size_t>(animation.source)]["channels"][channel]["target"];
  }

  Status check_node(const std::string& pointer, const KeyPointer& to) const {
    const Json& nodes = array_of(document_.json, "nodes");
    if (to.node >= static_cast<std::int64_t>(nodes.size()))
      return Error{pointer + "/target", fmt::format("points to node {} of {}", to.node, nodes.size()),
                   "name one of these"};
    const auto its = static_cast<std::size_t>(node_of_[static_cast<std::size_t>(to.node)]);
    if (has_extension(level_.nodes[its], to.key)) return Done{};
    return Error{pointer + "/target",
                 fmt::format("points to PLIANT_{} of node {}, which has none", extension_of_key(to.key), to.node),
                 "add the extension to the node, or remove the channel"};
  }

  // One sentence for all of the file.
  void note_other(const std::string& pointer, const std::string& aim) {
    if (other_pointers_++ == 0) other_ = fmt::format("{} ({})", aim.substr(0, 100), pointer);
  }

  static const char* extension_of_key(const std::string& key) {
    return find_varying_key(key)->of_joint() ? "joint" : "deformable";
  }

  // Returns "" or an error. Array sizes and the order of times have been checked.
  static std::string fill(LevelChannel& channel, const std::vector<float>& times, const std::vector<float>& values) {
    Track& track = channel.track;
    const bool turns = channel.property == NodeProperty::kRotation, key = channel.property == NodeProperty::kKey;
    const bool spline = track.interpolation == Interpolation::kCubicSpline;
    const std::size_t width = key ? 1 : turns ? 4 : 3;
    const Key* const varied = key ? find_key(*find_extension(extension_of_key(channel.key)), channel.key) : nullptr;
    track.times.assign(times.begin(), times.end());
    if (track.times.back() > kFarthest) return fmt::format("lasts longer than {:g} s; shorten it", kFarthest);
    for (std::size_t i = 0; i + width <= values.size(); i += width)
      if (key)
        track.values.emplace_back(values[i], 0.0f, 0.0f, 0.0f);
      else
        track.values.emplace_back(values[i], values[i + 1], values[i + 2], turns ? values[i + 3] : 0.0f);
    for (std::size_t i = 0; i < track.values.size(); ++i) {
      // A tangent is a rate. Its effect until the next key is at most its product with the interval, which is checked
      // here.
      const bool tangent = spline && i % 3 != 1;
      double seconds = 1.0;
      if (tangent && i % 3 == 2 && i / 3 + 1 < track.times.size())
        seconds = track.times[i / 3 + 1] - track.times[i / 3];
      if (tangent && i % 3 == 0 && i > 0) seconds = track.times[i / 3] - track.times[i / 3 - 1];
      const double size = length(track.values[i]) * seconds;
      if (key && !tangent && !varied->range.holds(track.values[i].x))
        return fmt::format("varies `{}` to {:g}, and it must be in the range {}", channel.key, track.values[i].x,
                           range_text(*varied));
      if (!(size <= (key ? 10.0 * varied->range.max : kFarthest)))
        return fmt::format("holds a value larger than {:g} in key {}; correct it", kFarthest, i);
      if (turns && !tangent && !(size > 1e-3)) return fmt::format("holds a rotation without length in key {}", i);
    }
    return "";
  }

  const SourceDocument& document_;
  Level& level_;
  std::vector<std::int32_t> node_of_;  // glTF number -> Level node
  std::uint64_t keys_ = 0;             // so far, of all channels
  std::size_t other_pointers_ = 0;     // channels that are not played
  std::string other_;                  // the first of them
};

}  // namespace

Status read_animations(const SourceDocument& document, Level& level) {
  AnimationReader reader(document, level);
  for (std::size_t a = 0; a < document.model.animations.size(); ++a)
    if (Status s = reader.animation(document.model.animations[a], a); !s) return s;
  reader.say_other();
  return Done{};
}

}  // namespace pliant
