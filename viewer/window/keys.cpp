#include "viewer/window/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "runtime/assert.h"
#include "viewer/window/window_input.h"

namespace pliant {
namespace {

struct NamedKey {
  const char* name;
  int key;
};
constexpr NamedKey kNamed[] = {
    {"Tab", GLFW_KEY_TAB},         {"Esc", GLFW_KEY_ESCAPE},
    {"Space", GLFW_KEY_SPACE},     {"Home", GLFW_KEY_HOME},
    {"End", GLFW_KEY_END},         {"Enter", GLFW_KEY_ENTER},
    {"Delete", GLFW_KEY_DELETE},   {"Backspace", GLFW_KEY_BACKSPACE},
    {"Left", GLFW_KEY_LEFT},       {"Right", GLFW_KEY_RIGHT},
    {"Up", GLFW_KEY_UP},           {"Down", GLFW_KEY_DOWN},
    {"PageUp", GLFW_KEY_PAGE_UP},  {"PageDown", GLFW_KEY_PAGE_DOWN},
    {".", GLFW_KEY_PERIOD},        {",", GLFW_KEY_COMMA},
    {"/", GLFW_KEY_SLASH},         {"-", GLFW_KEY_MINUS},
    {"=", GLFW_KEY_EQUAL},         {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET}, {"Escape", GLFW_KEY_ESCAPE}};  // the first of two names is written

constexpr KeyRow kKeyRows[] = {
    {kStopAction, kStopKeys, "emergency stop: no device has force until it is armed", kStopKeys,
     "Emergency stop of devices"},
    {"view.frame", "F", "see everything", "F", "Frame selected"},
    {"view.home", "Home", "; the first view", "Home", "Frame all"},
    {"view.front", "1", "from the front", "1", "From the front"},
    {"view.right", "3", ", the right", "3", "From the right"},
    {"view.top", "7", ", above", "7", "From above"},
    {"play.toggle", "Space", "pause, which lets devices go", "Space", "Play or pause"},
    {"play.restart", "R", "; start anew", "Ctrl+R", "Restart"},
    {"view.wireframe", "W", "wireframe", "W", "Wireframe"},
    {"view.zones", "Z", ", zones"},
    {"view.height", "H", ", height as colour"},
    {"view.contact_frames", "C", "contact frames"},
    {"play.forces", "A", ", force arrows", "", "Show forces"},
    {"view.shadows", "S", ", shadows"},
    {"view.tetrahedra", "T", "tetrahedra"},
    {"play.contacts", "K", ", contacts of soft bodies", "", "Show contacts"},
    {"view.handles", "G", ", handles of tools"},
    {"file.screenshot", "F12", "screenshot into the run's folder"},
    {"view.figures", "Tab", "hide or show figures"},
    {"help.keys", "F1", "; this page", "F1", "Keys\u2026"},
    {"view.devices", "D", "devices: state, axes, forces, arming"},
    {"view.levels", "L", "sliders, levels, recording"},
    {"play.mouse", "M", ", the mouse moves the next probe"},
    {"", "Drop a file", "open it"},
    {"file.close", "Esc", "close"},
};

constexpr MouseRow kMouseRows[] = {
    {"Left button on a surface or body", "press; hold it down, drag to slide"},
    {"Ctrl + left on a body", "pull it; wheel: away or near"},
    {"Wheel while pressing", "deeper or shallower"},
    {"Ctrl + wheel", "stay pressed at a depth"},
    {"Left button on a tool", "carry it; wheel: away or near"},
    {"Left on nothing, right, Alt + left", "turn the view"},
    {"Middle, Shift + left", "shift the view"},
    {"Wheel", "nearer or farther"},
};

}  // namespace

bool parse_keys(const std::string& keys, int& key, std::uint8_t& modifiers) {
  modifiers = 0;
  key = 0;
  std::string rest = keys;
  for (;;) {
    const std::size_t plus = rest.find('+', 1);
    if (plus == std::string::npos) break;
    const std::string word = rest.substr(0, plus);
    if (word == "Ctrl")
      modifiers |= kControl;
    else if (word == "Shift")
      modifiers |= kShift;
    else if (word == "Alt")
      modifiers |= kAlt;
    else
      return false;
    rest = rest.substr(plus + 1);
  }
  if (rest.size() == 1 && std::isalnum(static_cast<unsigned char>(rest[0]))) {
    key = std::toupper(static_cast<unsigned char>(rest[0]));
    return true;
  }
  for (const NamedKey& named : kNamed)
    if (rest == named.name) {
      key = named.key;
      return true;
    }
  if (rest.size() < 2 || rest[0] != 'F') return false;
  int n = 0;
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), n);
  if (error != std::errc() || end != rest.data() + rest.size() || n < 1 || n > 12) return false;
  key = GLFW_KEY_F1 + n - 1;
  return true;
}

std::string keys_text(int key, std::uint8_t modifiers) {
  std::string text;
  if (modifiers & kControl) text += "Ctrl+";
  if (modifiers & kAlt) text += "Alt+";
  if (modifiers & kShift) text += "Shift+";
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return text + fmt::format("F{}", key - GLFW_KEY_F1 + 1);
  for (const NamedKey& named : kNamed)
    if (key == named.key) return text + named.name;
  if (key > 32 && key < 127) return text + static_cast<char>(key);
  return {};
}

std::span<const KeyRow> key_rows() {
  return kKeyRows;
}

const KeyRow& key_row(const std::string& id) {
  const auto row =
      std::find_if(std::begin(kKeyRows), std::end(kKeyRows), [&](const KeyRow& each) { return each.id == id; });
  ASSERT(row != std::end(kKeyRows));
  return *row;
}

const KeyRow* window_key(int key) {
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) key = '0' + key - GLFW_KEY_KP_0;
  const std::string text = keys_text(key, 0);
  for (const KeyRow& row : kKeyRows)
    if (!text.empty() && text == row.window && row.id != std::string(kStopAction)) return &row;
  return nullptr;
}

std::span<const MouseRow> mouse_rows() {
  return kMouseRows;
}

}  // namespace pliant
