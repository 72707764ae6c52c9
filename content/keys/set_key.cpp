// --set NODE.EXT.KEY=VALUE, using the table of extensions.
#include <algorithm>

#include "content/gltf/form/gltf_document.h"
#include "content/keys/extension_table.h"
#include "content/level_file.h"

namespace pliant {

namespace {

struct Assignment {
  std::string node, extension, key;
  Json value;
};

// Parses the value as JSON; if that fails, takes the text itself: 300, true, [1, 0, 0], sls.
Json value_of_text(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(text) : json;
}

// The nodes that `text` refers to: all of that name, or the one of that glTF number where no node has the name; `*`:
// all.
std::vector<std::size_t> nodes_of(const Level& level, const std::string& text) {
  std::vector<std::size_t> named;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (text == "*" || level.nodes[i].name == text) named.push_back(i);
  const Json number = Json::parse(text, nullptr, false);
  if (!named.empty() || !number.is_number_unsigned()) return named;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (number == (level.source ? level.nodes[i].source : static_cast<std::int32_t>(i))) return {i};
  return named;
}

// Node names may contain dots: the node is the part before an extension's name.
bool split(const Level& level, const std::string& path, Assignment& out) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1)) {
    const std::size_t end = path.find('.', dot + 1);
    if (end == std::string::npos) break;
    out.node = path.substr(0, dot);
    out.extension = path.substr(dot + 1, end - dot - 1);
    out.key = path.substr(end + 1);
    if (!find_extension(out.extension)) continue;
    if (find_extension(out.extension)->on_scene || !nodes_of(level, out.node).empty()) return true;
  }
  // Not understood: split at the first two dots for the error message.
  const std::size_t first = path.find('.');
  const std::size_t second = first == std::string::npos ? first : path.find('.', first + 1);
  if (second == std::string::npos) return false;
  out = {path.substr(0, first), path.substr(first + 1, second - first - 1), path.substr(second + 1), {}};
  return true;
}

// A node is referred to as in a file, by name or by glTF number; a matching name has precedence.
Json name_of_node(const Level& level, const std::string& text) {
  if (text == "*") return text;
  const std::vector<std::size_t> found = nodes_of(level, text);
  return found.empty() ? text : level.nodes[found.front()].name;
}

// An extension that was modified, and the last assignment to it.
struct Touched {
  const Extension* extension;
  void* owner;
  std::string where;
};

void assign(const Extension& extension, const Key& key, const Json& value, void* owner, const std::string& where,
            std::vector<Touched>& touched) {
  // Stiffness and Young's modulus exclude each other: the last one set wins.
  if (extension.name == "deformable" && key.name == "stiffness")
    static_cast<LevelNode*>(owner)->deformable->young = 0.0;
  key.set(owner, value);
  note_stated(extension, key, owner);
  for (Touched& each : touched)
    if (each.extension == &extension && each.owner == owner) {
      each.where = where;
      return;
    }
  touched.push_back({&extension, owner, where});
}

// Applies one assignment. Derived values and conflicts are handled at the end, as for a file.
Status set_one(Level& level, const std::string& assignment, std::vector<Touched>& touched) {
  const std::string where = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  Assignment it;
  if (equals == std::string::npos || !split(level, assignment.substr(0, equals), it))
    return Error{where, "is not NODE.EXTENSION.KEY=VALUE", "write for example belly.deformable.stiffness=300"};
  const std::string text = assignment.substr(equals + 1);

  std::vector<std::string> extensions, nodes;
  for (const Extension& each : extension_table()) extensions.push_back(each.name);
  const Extension* extension = find_extension(it.extension);
  if (!extension) return error_at(where, unknown("extension", it.extension, "", "extensions", extensions));
  const Key* key = find_key(*extension, it.key);
  if (!key) return error_at(where, unknown_key(*extension, it.key));
  if (key->type == KeyType::kNode)
    it.value = name_of_node(level, text);
  else if (key->type == KeyType::kText || key->type == KeyType::kChoice)
    it.value = text;
  else
    it.value = value_of_text(text);
  if (std::optional<Note> wrong = check_value(*key, it.value)) {
    wrong->what = it.key + " " + wrong->what;
    (wrong->cure.empty() ? wrong->what : wrong->cure) += " (" + key->doc + ")";
    return error_at(where, *wrong);
  }

  if (key->name == "stiffness" && extension->name == "deformable")
    for (const std::size_t i : nodes_of(level, it.node))
      if (stiffness_of_table(level.nodes[i]))
        return Error{where, "follows from the rows of its table", "set `table` instead, or another `spring` first",
                     "key.both"};

  if (extension->on_scene) {
    if (!extension->present(&level)) extension->add(&level);
    assign(*extension, *key, it.value, &level, where, touched);
    return Done{};
  }
  const std::vector<std::size_t> meant = nodes_of(level, it.node);
  bool done = false;
  for (const std::size_t i : meant) {
    LevelNode& node = level.nodes[i];
    if (!extension->present(&node)) continue;
    assign(*extension, *key, it.value, &node, where, touched);
    done = true;
  }
  for (const LevelNode& node : level.nodes)
    if (extension->present(&node)) nodes.push_back(node.name);
  std::string have;
  for (std::size_t i = 0; i < nodes.size() && i < 5; ++i) have += (i ? ", " : "") + nodes[i];
  const std::string hint = have.empty() ? "no node of this level has one" : "nodes that have one: " + have;
  const std::string near = suggestion(it.node, nodes);
  if (meant.empty() && it.node != "*")
    return Error{where, "names the node '" + it.node + "', which the level does not have", near.empty() ? hint : near,
                 "name.unknown"};
  if (!done) return Error{where, "names a node without PLIANT_" + it.extension, hint, "name.unknown"};
  if (key->type == KeyType::kNode || key->type == KeyType::kNames)
    if (const Status status = check_references(level); !status) return status.error().at(where);
  return Done{};
}

}  // namespace

Status set_keys(Level& level, const std::vector<std::string>& assignments) {
  // All assignments take effect, or none.
  Level changed;
  changed.nodes = level.nodes;
  changed.environment = level.environment;
  changed.simulation = level.simulation;
  changed.source = level.source;
  changed.stated = level.stated;
  std::vector<Touched> touched;
  for (const std::string& assignment : assignments)
    if (const Status status = set_one(changed, assignment, touched); !status) return status;
  for (const Touched& each : touched)
    if (const std::optional<Note> clash = each.extension->settle(each.owner)) return error_at(each.where, *clash);
  level.nodes = std::move(changed.nodes);
  level.environment = std::move(changed.environment);
  level.simulation = changed.simulation;
  level.stated = std::move(changed.stated);
  return Done{};
}

Status set_key(Level& level, const std::string& assignment) {
  return set_keys(level, {assignment});
}

}  // namespace pliant
