#include "content/level/spawn_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/files/file_io.h"
#include "content/level/node_error.h"
#include "content/level/script.h"

namespace pliant {
namespace {

constexpr double kEven = 1e-4;         // [1] relative tolerance for equal scales: files have single precision
constexpr double kFarthestMove = 1e6;  // [m], [s] of a script

Track& track_of(PrescribedMotion& motion, NodeProperty property) {
  if (property == NodeProperty::kTranslation) return motion.translation;
  return property == NodeProperty::kRotation ? motion.rotation : motion.scale;
}

bool empty(const PrescribedMotion& motion) {
  return motion.translation.empty() && motion.rotation.empty() && motion.scale.empty();
}

// Whether the motion is constant.
bool stands(const PrescribedMotion& motion) {
  const auto constant = [](const Track& track) { return track.times.size() <= 1; };
  return motion.speed == 0.0 || (constant(motion.translation) && constant(motion.rotation) && constant(motion.scale));
}

// A rotation and uniform scale (or mirroring): rotations in this frame are rigid.
bool is_even(const dmat4& frame) {
  const dvec3 x(frame[0]), y(frame[1]), z(frame[2]);
  const double size = std::max({dot(x, x), dot(y, y), dot(z, z)});
  const auto small = [&](double value) { return std::abs(value) <= kEven * size; };
  return small(dot(x, y)) && small(dot(y, z)) && small(dot(z, x)) && small(dot(x, x) - dot(y, y)) &&
         small(dot(y, y) - dot(z, z));
}

class MotionMaker {
 public:
  MotionMaker(const Level& level, const std::filesystem::path& folder, ScriptLibrary& scripts)
      : level_(level), folder_(folder), scripts_(scripts), channels_(level.nodes.size()), varied_(level.nodes.size()) {}

  Result<LevelMotions> make() {
    const std::size_t count = level_.nodes.size();
    out_.motion.resize(count);
    out_.moves.assign(count, false);
    out_.world.assign(count, dmat4(1.0));
    for (const LevelNode& node : level_.nodes) out_.local.push_back(node.local);
    for (std::size_t a = 0; a < level_.animations.size(); ++a)
      for (const LevelChannel& channel : level_.animations[a].channels)
        (channel.property == NodeProperty::kKey ? varied_ : channels_)[static_cast<std::size_t>(channel.node)]
            .push_back({a, &channel});
    look_below();
    for (std::size_t n = 0; n < count; ++n)
      if (Status s = node(n); !s) return s.error();
    if (!left_behind_.empty())
      out_.notes.push_back("cameras, lights, probes and devices are not carried: `" + left_behind_ +
                           "` stays where it is at the start");
    return std::move(out_);
  }

 private:
  struct Source {
    std::size_t animation;
    const LevelChannel* channel;
  };

  Error at(std::size_t n, std::string what, std::string cure) const {
    return node_error(level_, n, {"", std::move(what), std::move(cure), "level.motion"});
  }
  Error around(std::size_t n, const Error& error) const { return node_error_around(level_, n, error); }
  void note(std::size_t n, const std::string& what, const std::string& cure = {}) {
    out_.notes.push_back("node `" + level_.nodes[n].name + "` " + sentence_of(what, cure));
  }

  // Finds nodes that can be touched or have such a node below them; and whether anything is moved by contacts.
  void look_below() {
    touched_.assign(level_.nodes.size(), false);
    for (std::size_t n = level_.nodes.size(); n-- > 0;) {
      const LevelNode& node = level_.nodes[n];
      if (!node.in_scene) continue;
      if (node.deformable || node.effect || node.rigid_body) touched_[n] = true;
      if (node.soft_body || (node.rigid_body && !node.rigid_body->fixed)) something_is_pushed_ = true;
      if (touched_[n] && node.parent >= 0) touched_[static_cast<std::size_t>(node.parent)] = true;
    }
  }

  Status node(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const auto parent = static_cast<std::size_t>(node.parent);
    const dmat4 above = node.parent < 0 ? dmat4(1.0) : out_.world[parent];
    LocalFrame frame = local_frame(node.local);
    if (node.in_scene && (node.motion || !channels_[n].empty())) {
      PrescribedMotion motion;
      if (Status s = read(n, motion); !s) return s;
      if (Status s = keep_shape(n, above, motion); !s) return s;
      if (!empty(motion)) {
        frame = sample_motion(motion, node.local, 0.0);
        out_.local[n] = {vec3(frame.translation), quat(frame.rotation), vec3(frame.scale)};
        if (!stands(motion)) out_.motion[n] = std::move(motion);
      }
    }
    // A static node takes its transform from its component, in single precision.
    out_.world[n] = above * (out_.motion[n] ? frame : local_frame(out_.local[n])).matrix();
    out_.moves[n] = out_.motion[n] || (node.parent >= 0 && out_.moves[parent]);
    return out_.moves[n] && node.in_scene ? check_carried(n) : Done{};
  }

  // The node's own motion, from file and script.
  Status read(std::size_t n, PrescribedMotion& motion) {
    const NodeMotion asked = level_.nodes[n].motion.value_or(NodeMotion{});
    motion.repeats = asked.repeat;
    motion.speed = asked.speed;
    if (!asked.script.empty()) return read_script(n, asked.script, motion);
    bool found = false, twice = false;
    for (const Source& source : channels_[n]) {
      if (!asked.animation.empty() && level_.animations[source.animation].name != asked.animation) continue;
      found = true;
      Track& track = track_of(motion, source.channel->property);
      if (track.empty())
        track = source.channel->track;
      else
        twice = true;
    }
    if (twice) note(n, "is moved by several animations: the first counts", "name one in PLIANT_motion/animation");
    for (const Source& source : varied_[n])
      found = found || asked.animation.empty() || level_.animations[source.animation].name == asked.animation;
    if (found) return Done{};
    if (!asked.animation.empty())
      return at(n,
                "PLIANT_motion/animation names `" + asked.animation.substr(0, 100) + "`, which does not move this node",
                "name an animation that does, or leave the key out");
    note(n, "has PLIANT_motion, but no animation moves it and it names no script");
    return Done{};
  }

  Status read_script(std::size_t n, const std::string& file, PrescribedMotion& motion) {
    const Result<std::filesystem::path> path = confined_path(folder_, file);
    if (!path) return around(n, path.error());
    const Result<const Path*> read = scripts_.read(*path, true);
    if (!read) return around(n, read.error());
    const Path* script = *read;
    for (const PathRow& row : script->rows) {
      const dvec3 far = glm::abs(row.position);
      if (row.time < 0.0 || row.time > kFarthestMove || std::max({far.x, far.y, far.z}) > kFarthestMove)
        return at(n,
                  fmt::format("is moved by {}, which has a time or place outside 0 to {:g} s and {:g} m",
                              file.substr(0, 100), kFarthestMove, kFarthestMove),
                  "correct it");
      motion.translation.times.push_back(row.time);
      motion.translation.values.emplace_back(row.position, 0.0);
      if (!script->turns) continue;
      motion.rotation.times.push_back(row.time);
      motion.rotation.values.emplace_back(row.rotation.x, row.rotation.y, row.rotation.z, row.rotation.w);
    }
    motion.translation.length = motion.rotation.length = script->rows.back().time;
    return Done{};
  }

  // A touchable node keeps its shape: scale and shear are baked into its mesh.
  Status keep_shape(std::size_t n, const dmat4& above, PrescribedMotion& motion) {
    if (!touched_[n]) return Done{};
    if (!motion.scale.empty()) {
      motion.scale = {};
      note(n, "is not scaled by its animation: what can be touched keeps its size");
    }
    if (motion.rotation.empty() || is_even(above)) return Done{};
    constexpr const char* kUneven = "the nodes above it scale unevenly, so that turning it would change its shape";
    if (level_.nodes[n].motion && !level_.nodes[n].motion->script.empty())
      return at(n, fmt::format("is turned by a script, but {}", kUneven), "apply their scale to the mesh");
    motion.rotation = {};
    note(n, fmt::format("is not turned by its animation: {}", kUneven));
    return Done{};
  }

  Status check_carried(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (node.soft_body || node.handle)
      return at(n, "is a soft body or a tool that an animation or a script moves, which is not supported",
                "move a `fixed` rigid body and hold it by a joint, or set PLIANT_motion/speed of that node to 0");
    if (node.rigid_body && !node.rigid_body->fixed)
      return at(n, "is a rigid body that an animation or a script moves, and that contacts move, too",
                "set `fixed`, so that its motion alone moves it, or PLIANT_motion/speed of that node to 0");
    if (node.deformable && something_is_pushed_)
      return at(n, "is moved by an animation or a script in a level with soft or rigid bodies, which is not supported",
                "leave those out, or set PLIANT_motion/speed of the node to 0");
    if (node.deformable) {
      const dmat4& m = out_.world[n];
      if (length(dvec3(m[0])) == 0.0 || length(dvec3(m[1])) == 0.0)
        return at(n, "moves with a scale of zero", "give the node and its parents a scale other than 0");
    }
    if ((node.camera || node.light || node.probe || node.device) && left_behind_.empty()) left_behind_ = node.name;
    return Done{};
  }

  const Level& level_;
  const std::filesystem::path& folder_;
  ScriptLibrary& scripts_;
  std::vector<std::vector<Source>> channels_;  // of each node, in the order of the file
  std::vector<std::vector<Source>> varied_;    // the same: of its keys (spawn_varying.h)
  std::vector<bool> touched_;
  bool something_is_pushed_ = false;
  std::string left_behind_;  // name of the first static node that is not carried by its moving parent
  LevelMotions out_;
};

}  // namespace

Result<LevelMotions> make_motions(const Level& level, const std::filesystem::path& folder, ScriptLibrary& scripts) {
  return MotionMaker(level, folder, scripts).make();
}

LevelMotions unmoved(const Level& level) {
  LevelMotions out;
  out.motion.resize(level.nodes.size());
  out.moves.assign(level.nodes.size(), false);
  for (const LevelNode& node : level.nodes) {
    out.local.push_back(node.local);
    const dmat4 above = node.parent < 0 ? dmat4(1.0) : out.world[static_cast<std::size_t>(node.parent)];
    out.world.push_back(above * local_frame(node.local).matrix());
  }
  return out;
}

}  // namespace pliant
