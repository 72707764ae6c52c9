// The rows of extensions.h's table, for the files that iterate over it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/range.h"
#include "content/keys/extensions.h"

namespace pliant {

enum class KeyType {
  kNumber,
  kFlag,
  kText,
  kChoice,
  kColor,
  kPair,
  kVector,
  kPoints,
  kTable,
  kBox,
  kNode,
  kNames,
  kNumberOrMaterial,
  kItems
};

inline constexpr std::size_t kMostPoints = 16;  // of a key of type kPoints
inline constexpr std::size_t kMostNames = 64;   // of a key of type kNames

inline constexpr std::size_t kMostSliders = 32;  // of the key `expose`
inline constexpr std::size_t kMostItems = kMostLayers;  // of a key of type kItems

// One key. The owner, passed as void*, is a LevelNode (node extensions) or Level (scene extensions).
struct Key {
  std::string name;  // dots are nested objects: relaxation.time
  std::string unit;
  KeyType type = KeyType::kNumber;
  Range range;
  Range usual;                                      // `validate` queries values outside of it, except 0
  std::vector<std::string> (*choices)() = nullptr;  // of a choice: its words, including registered ones
  std::string doc;
  std::vector<Key> items;            // of a list of objects: their keys
  std::size_t most = kMostItems;     // of these objects
  const void* usual_item = nullptr;  // the owner of these, with its defaults
  bool alias = false;                // sets other keys; never saved
  bool whole = false;                // a number without a fraction
  std::function<Json(const void*)> get;
  std::function<void(void*, const Json&)> set;  // requires a checked value
};

struct Extension {
  std::string name;  // without PLIANT_
  std::string doc;
  bool on_scene = false;
  std::vector<Key> keys;
  std::function<bool(const void*)> present;
  std::function<void(void*)> add;  // adds it with defaults
  // After keys were set: computes derived values. Returns the fault if keys conflict, `of` the key to change.
  std::function<std::optional<Note>(void*)> settle;
};

const std::vector<Extension>& extension_table();
const Extension* find_extension(const std::string& name);
// Records in LevelNode::stated or Level::stated that the file sets the key.
void note_stated(const Extension& extension, const Key& key, void* owner);
const Key* find_key(const Extension& extension, const std::string& name);
// The key of NODE.EXTENSION.KEY; the node's name may contain dots. nullptr: none.
const Key* find_key_of_path(const std::string& path);

// Whether its stiffness follows from the rows of `table`.
bool stiffness_of_table(const LevelNode& node);

// Makes the constants of a fresh component, which an unstated key has beside the `young` of this node.
void scale_defaults(LevelNode& fresh, const LevelNode& node);

std::optional<Note> check_value(const Key& key, const Json& value);  // the fault
std::string range_text(const Key& key);
// A question if a number (or any component of a vector or point) is outside the usual range, with the unit that was
// perhaps meant.
std::optional<Note> doubt(const Key& key, const Json& value);
std::string usual_text(const Key& key);
// "a, b and c".
std::string listed(const std::vector<std::string>& words);
// The closest of `names`, or "" if none is close.
std::string nearest(const std::string& word, const std::vector<std::string>& names);
// "did you mean X?", or "".
std::string suggestion(const std::string& word, const std::vector<std::string>& names);
// "unknown `what` 'word' in `in`; did you mean X?", or, if none is close, "...; `all` are: A, B, C".
Note unknown(const std::string& what, const std::string& word, const std::string& in, const std::string& all,
             const std::vector<std::string>& names);
Note unknown_key(const Extension& extension, const std::string& word);

}  // namespace pliant
