// Keys: their names, and one table of what they do over a level's picture in the window of a run and in the editor.
// Both programs' help shows it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pliant {

// "Ctrl+Shift+S" -> modifiers and key as GLFW numbers it; false: not understood.
bool parse_keys(const std::string& keys, int& key, std::uint8_t& modifiers);
std::string keys_text(int key, std::uint8_t modifiers);

// The emergency stop's action, whose keys the user may change (Settings::keys), and its default key.
inline constexpr const char *kStopAction = "device.stop", *kStopKeys = "F9";

struct KeyRow {
  const char* id;      // of the action; "": not a key
  const char* window;  // key in the window of a run
  const char* words;   // of its help; those that begin with a comma or semicolon continue the line before
  // In the editor, whose keys can be changed: default keys, and the menu's label. Null: not there.
  const char *editor = nullptr, *label = nullptr;
};
std::span<const KeyRow> key_rows();
const KeyRow& key_row(const std::string& id);  // of the table
// The row of a key in the window of a run; null: none.
const KeyRow* window_key(int key);

struct MouseRow {
  const char *how, *words;
};
// Over the picture: of a run, and in the editor of a played level; the last three move the view.
std::span<const MouseRow> mouse_rows();

}  // namespace pliant
