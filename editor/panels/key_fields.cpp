#include "editor/panels/key_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/panels/property_row.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kUnbounded = 1e12;

double least_of(const Key& key) {
  return std::max(key.range.above_min ? std::nextafter(key.range.min, 1e300) : key.range.min, -kUnbounded);
}
double most_of(const Key& key) {
  return std::min(key.range.max, kUnbounded);
}

bool number_field(const Key& key, const char* label, Json& value, float width = 0) {
  double number = value.is_number() ? value.get<double>() : 0.0;
  if (!ui::number(label, number, least_of(key), most_of(key), key.unit.c_str(), most_of(key) > 1e3, width))
    return false;
  value = number;
  return true;
}

// Unit of the i-th number of a row: "N/m, N s/m" are two units. There is no space to show it.
std::string row_unit(const std::string& units, std::size_t i) {
  std::size_t begin = 0;
  for (; i > 0; --i) {
    const std::size_t comma = units.find(", ", begin);
    if (comma == std::string::npos) break;
    begin = comma + 2;
  }
  return "#" + units.substr(begin, units.find(", ", begin) - begin);
}

// Several numbers in a row; editing one of them edits the whole value.
bool row_field(const Key& key, Json& value, std::size_t count) {
  const float wide = (ImGui::GetContentRegionAvail().x - ui::px(4) * static_cast<float>(count - 1)) /
                     static_cast<float>(count) / ui::scale();
  bool changed = false;
  Json next = value.is_array() && value.size() == count ? value : Json(std::vector<double>(count, 0.0));
  for (std::size_t i = 0; i < count; ++i) {
    if (i) ImGui::SameLine(0, ui::px(4));
    double number = next[i].is_number() ? next[i].get<double>() : 0.0;
    if (ui::number(fmt::format("{} {}", key.name, i + 1).c_str(), number, least_of(key), most_of(key),
                   row_unit(key.unit, i).c_str(), false, wide)) {
      next[i] = number;
      changed = true;
    }
  }
  if (changed) value = std::move(next);
  return changed;
}

bool node_field(Editor& editor, const Key& key, Json& value) {
  std::string name = value.is_string() ? value.get<std::string>() : "";
  std::vector<std::string> names{""};
  for (const auto& each : editor.state().nodes)
    if (each->node.device) names.push_back(each->node.name);
  if (!ui::combo(key.name.c_str(), name, names)) return false;
  value = name;
  return true;
}

// One box per probe; none is ticked: all of them. Names without a probe, which are errors, can be unticked.
bool names_field(Editor& editor, const Key& key, Json& value) {
  std::vector<std::string> names =
      value.is_array() ? value.get<std::vector<std::string>>() : std::vector<std::string>();
  std::vector<std::string> shown;
  for (const auto& each : editor.state().nodes)
    if (each->node.probe) shown.push_back(each->node.name);
  for (const std::string& name : names)
    if (std::find(shown.begin(), shown.end(), name) == shown.end()) shown.push_back(name);
  bool changed = false;
  for (const std::string& name : shown) {
    bool on = std::find(names.begin(), names.end(), name) != names.end();
    ImGui::PushID(name.c_str());
    if (ImGui::Checkbox(name.c_str(), &on)) {
      std::erase(names, name);
      if (on) names.push_back(name);
      changed = true;
    }
    ui::known_as(key.name + " " + name);
    ImGui::PopID();
  }
  if (changed) value = names;
  return changed;
}

// The key for the device's id: requests can be picked from a list.
const Key* device_id_key() {
  static const Key* const key = find_key(*find_extension("haptic_device"), "id");
  return key;
}

bool pick_device(Editor& editor, std::string& request) {
  if (!editor.devices_looked_for) editor.look_for_devices();
  const bool open = ImGui::BeginCombo("##pick", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft);
  ui::known_as("Pick device");
  if (!open) {
    ui::hint("Kinds of device, and those that are here");
    return false;
  }
  bool picked = false;
  {
    const ui::Scope scope("Pick device");
    for (const std::string& each : editor.device_requests())
      if (ui::selectable(each.c_str(), each == request)) {
        request = each;
        picked = true;
      }
  }
  ImGui::EndCombo();
  return picked;
}

bool box_field(const Key& key, Json& value) {
  const bool has = value.is_object();
  bool changed = false;
  if (!has) {
    if (!ui::button(fmt::format("Set##{}", key.name).c_str())) return false;
    value = Json{{"min", {-0.01, -0.01, -0.01}}, {"max", {0.01, 0.01, 0.01}}};
    return true;
  }
  Json next = value;
  for (const char* corner : {"min", "max"}) {
    Key part = key;
    part.name = key.name + " " + corner;
    part.unit = "m";
    part.range = {-1e6, 1e6};
    changed |= row_field(part, next[corner], 3);
  }
  if (ui::button(fmt::format("None##{}", key.name).c_str())) {
    value = nullptr;
    return true;
  }
  if (changed) value = std::move(next);
  return changed;
}

// A list of rows of `width` numbers: at least `least` of them, or none. The editor adds a row beyond the last.
bool rows_field(const Key& key, Json& value, std::size_t width, std::size_t least, std::size_t most) {
  Json next = value.is_array() ? value : Json::array();
  bool changed = false;
  for (std::size_t i = 0; i < next.size(); ++i) {
    Key part = key;
    part.name = fmt::format("{} {}", key.name, i + 1);
    changed |= row_field(part, next[i], width);
  }
  if (next.size() < most && ui::button(fmt::format("Add##{}", key.name).c_str())) {
    if (key.type == KeyType::kTable && next.empty())
      next = {{0.0, 0.0}, {0.001, 0.3}};
    else if (key.type == KeyType::kTable)
      next.push_back({2 * next.back()[0].get<double>(), 2 * next.back()[1].get<double>()});
    else
      next.push_back(std::vector<double>(width, 0.0));
    changed = true;
  }
  if (!next.empty()) {
    ImGui::SameLine();
    if (ui::button(fmt::format("Remove##{}", key.name).c_str())) {
      next.erase(next.size() - 1);
      if (next.size() < least) next = Json::array();
      changed = true;
    }
  }
  if (changed) value = std::move(next);
  return changed;
}

// A list of objects: the fields of each, a button that adds one and one that removes the last.
bool items_field(Editor& editor, const Key& key, Json& value) {
  Json next = value.is_array() ? value : Json::array();
  bool changed = false;
  for (std::size_t i = 0; i < next.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    for (const Key& of : key.items) {
      Key part = of;
      part.name = fmt::format("{} {} {}", key.name, i + 1, of.name);
      const Json otherwise = of.get(key.usual_item);
      Json item = next[i].contains(of.name) ? next[i][of.name] : otherwise;
      if (property_row(fmt::format("{} {}", i + 1, of.name).c_str(), of.doc.c_str(), item != otherwise)) {
        next[i].erase(of.name);
        changed = true;
      } else if (key_field(editor, part, item)) {
        next[i][of.name] = item;
        changed = true;
      }
    }
    ImGui::PopID();
  }
  if (next.size() < key.most && ui::button(fmt::format("Add##{}", key.name).c_str())) {
    Json item = Json::object();
    if (key.name == "layers") item["force"] = 1.0;  // one of its limits is required
    next.push_back(std::move(item));
    changed = true;
  }
  if (!next.empty()) {
    ImGui::SameLine();
    if (ui::button(fmt::format("Remove##{}", key.name).c_str())) {
      next.erase(next.size() - 1);
      changed = true;
    }
  }
  if (changed) value = std::move(next);
  return changed;
}

}  // namespace

bool key_field(Editor& editor, const Key& key, Json& value) {
  ImGui::PushID(key.name.c_str());
  bool changed = false;
  switch (key.type) {
    case KeyType::kNumber:
      changed = number_field(key, key.name.c_str(), value);
      break;
    case KeyType::kFlag: {
      bool on = value.is_boolean() && value.get<bool>();
      changed = ImGui::Checkbox("##flag", &on);
      ui::known_as(key.name);
      if (changed) value = on;
      break;
    }
    case KeyType::kText: {
      std::string text = value.is_string() ? value.get<std::string>() : "";
      const bool device = &key == device_id_key();
      changed = ui::text_field(key.name.c_str(), text, device ? "none: it does not move" : "none",
                               device ? ImGui::GetContentRegionAvail().x / ui::scale() - 30 : 0,
                               ImGuiInputTextFlags_EnterReturnsTrue);
      if (device) {
        ImGui::SameLine(0, ui::px(2));
        changed |= pick_device(editor, text);
      }
      if (changed) value = text;
      break;
    }
    case KeyType::kChoice: {
      std::string word = value.is_string() ? value.get<std::string>() : "";
      changed = ui::combo(key.name.c_str(), word, key.choices());
      if (changed) value = word;
      break;
    }
    case KeyType::kColor: {
      float rgb[3] = {0, 0, 0};
      for (std::size_t i = 0; i < 3 && value.is_array() && i < value.size(); ++i) rgb[i] = value[i].get<float>();
      changed = ui::color_field(key.name.c_str(), rgb);
      if (changed) value = Json::array({rgb[0], rgb[1], rgb[2]});
      break;
    }
    case KeyType::kPair:
      changed = row_field(key, value, 2);
      break;
    case KeyType::kVector:
      changed = row_field(key, value, 3);
      break;
    case KeyType::kPoints:
      changed = rows_field(key, value, 3, 1, kMostPoints);
      break;
    case KeyType::kTable:
      changed = rows_field(key, value, 2, 2, ForceTable::kMost);
      break;
    case KeyType::kNames:
      changed = names_field(editor, key, value);
      break;
    case KeyType::kItems:
      changed = items_field(editor, key, value);
      break;
    case KeyType::kBox:
      changed = box_field(key, value);
      break;
    case KeyType::kNode:
      changed = node_field(editor, key, value);
      break;
    case KeyType::kNumberOrMaterial: {
      // A number, or a word for a value derived from the material.
      bool material = value.is_string();
      changed = ImGui::Checkbox("material##of", &material);
      ui::known_as(key.name + " material");
      if (changed) value = material ? Json("material") : Json(0.0);
      if (!material && !changed) {
        ImGui::SameLine();
        changed = number_field(key, key.name.c_str(), value);
      }
      break;
    }
  }
  ImGui::PopID();
  return changed;
}

}  // namespace pliant
