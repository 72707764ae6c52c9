// --set NODE.EXT.KEY=VALUE, over the table of extensions.
#include <fmt/format.h>

#include "content/keys/extension_table.h"
#include "content/level_file.h"

namespace pliant {

namespace {

struct Assignment {
  std::string node, extension, key;
  Json value;
};

// A value is JSON where it parses as JSON, otherwise the text itself: 300, true, [1, 0, 0], sls.
Json value_of_text(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(text) : json;
}

// Node names may contain dots: the node is what stands before an extension's name.
bool split(const Level& level, const std::string& path, Assignment& out) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1)) {
    const std::size_t end = path.find('.', dot + 1);
    if (end == std::string::npos) break;
    out.node = path.substr(0, dot);
    out.extension = path.substr(dot + 1, end - dot - 1);
    out.key = path.substr(end + 1);
    if (!find_extension(out.extension)) continue;
    if (out.node == "*" || find_extension(out.extension)->on_scene) return true;
    for (const LevelNode& node : level.nodes)
      if (node.name == out.node) return true;
  }
  // Not understood: the first two dots divide it, for the sentence that says what is wrong.
  const std::size_t first = path.find('.');
  const std::size_t second = first == std::string::npos ? first : path.find('.', first + 1);
  if (second == std::string::npos) return false;
  out = {path.substr(0, first), path.substr(first + 1, second - first - 1), path.substr(second + 1), {}};
  return true;
}

Status assign(const Extension& extension, const Key& key, const Json& value, void* owner, const std::string& where) {
  // Stiffness and Young's modulus stand for each other: the one that is set last holds.
  if (extension.name == "deformable" && key.name == "stiffness")
    static_cast<LevelNode*>(owner)->deformable->young = 0.0;
  key.set(owner, value);
  if (const std::string clash = extension.settle(owner); !clash.empty()) return Error{where, clash};
  return Done{};
}

}  // namespace

Status set_key(Level& level, const std::string& assignment) {
  const std::string where = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  Assignment it;
  if (equals == std::string::npos || !split(level, assignment.substr(0, equals), it))
    return Error{where, "is not NODE.EXTENSION.KEY=VALUE; write for example belly.deformable.stiffness=300"};
  it.value = value_of_text(assignment.substr(equals + 1));

  std::vector<std::string> extensions, nodes;
  for (const Extension& each : extension_table()) extensions.push_back(each.name);
  const Extension* extension = find_extension(it.extension);
  if (!extension) return Error{where, unknown("extension", it.extension, "extensions", extensions)};
  const Key* key = find_key(*extension, it.key);
  if (!key) return Error{where, unknown_key(*extension, it.key)};
  if (key->type == KeyType::kText || key->type == KeyType::kNode || key->type == KeyType::kChoice)
    it.value = assignment.substr(equals + 1);
  const std::string wrong = check_value(*key, it.value);
  if (!wrong.empty()) return Error{where, it.key + " " + wrong + " (" + key->doc + ")"};

  // Nothing changes unless everything can.
  Level changed;
  changed.nodes = level.nodes;
  changed.environment = level.environment;
  changed.simulation = level.simulation;
  const auto keep = [&] {
    level.nodes = std::move(changed.nodes);
    level.environment = std::move(changed.environment);
    level.simulation = changed.simulation;
    return Done{};
  };
  if (extension->on_scene) {
    if (!extension->present(&changed)) extension->add(&changed);
    if (const Status status = assign(*extension, *key, it.value, &changed, where); !status) return status;
    return keep();
  }
  bool node_exists = it.node == "*", done = false;
  for (LevelNode& node : changed.nodes) {
    const bool here = it.node == "*" || node.name == it.node;
    node_exists |= here;
    if (extension->present(&node)) nodes.push_back(node.name);
    if (!here || !extension->present(&node)) continue;
    if (const Status status = assign(*extension, *key, it.value, &node, where); !status) return status;
    done = true;
  }
  std::string have;
  for (std::size_t i = 0; i < nodes.size() && i < 5; ++i) have += (i ? ", " : "") + nodes[i];
  const std::string hint = have.empty() ? "; no node of this level has one" : "; nodes that have one: " + have;
  if (!node_exists)
    return Error{where, "names the node '" + it.node + "', which the level does not have" +
                            (suggestion(it.node, nodes).empty() ? hint : suggestion(it.node, nodes))};
  if (!done) return Error{where, "names a node without PLIANT_" + it.extension + hint};
  if (key->type == KeyType::kNode)
    if (const Status status = check_references(changed); !status) return Error{where, status.error().what};
  return keep();
}

}  // namespace pliant
