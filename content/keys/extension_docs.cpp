// The key table as JSON Schemas and as Markdown.
#include <fmt/format.h>

#include <cmath>

#include "content/keys/extension_table.h"

namespace pliant {

namespace {

Json schema_of(const Key& key, const Json& standard) {
  Json out = {{"description",
               key.doc + (key.unit.empty() || key.unit == "1" || key.unit == "node" ? "" : " [" + key.unit + "]")}};
  const auto bound = [&](Json& json) {
    if (std::isfinite(key.range.min)) json[key.range.above_min ? "exclusiveMinimum" : "minimum"] = key.range.min;
    if (std::isfinite(key.range.max)) json["maximum"] = key.range.max;
  };
  const auto array = [&](std::size_t count) {
    Json items = {{"type", "number"}};
    bound(items);
    return Json{{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
  };
  if (!key.alias && !standard.is_null() && standard != Json("")) out["default"] = standard;
  switch (key.type) {
    case KeyType::kNumber:
      out["type"] = key.whole ? "integer" : "number";
      bound(out);
      break;
    case KeyType::kNumberOrMaterial: {
      Json number = {{"type", "number"}};
      bound(number);
      out["anyOf"] = Json::array({number, {{"const", "material"}}});
      break;
    }
    case KeyType::kFlag:
      out["type"] = "boolean";
      break;
    case KeyType::kText:
      out["type"] = "string";
      break;
    case KeyType::kNode:
      out["anyOf"] = Json::array({{{"type", "string"}}, {{"type", "integer"}, {"minimum", 0}}});
      break;
    case KeyType::kChoice:
      out["enum"] = key.choices();
      break;
    case KeyType::kColor:
      out.update(array(3));
      break;
    case KeyType::kPair:
      out.update(array(2));
      break;
    case KeyType::kVector:
      out["anyOf"] = Json::array({array(3), {{"type", "number"}}});
      break;
    case KeyType::kPoints:
      out["type"] = "array";
      out["items"] = array(3);
      out["maxItems"] = kMostPoints;
      break;
    case KeyType::kNames:
      out["type"] = "array";
      out["items"] = {{"type", "string"}, {"minLength", 1}};
      out["maxItems"] = kMostNames;
      break;
    case KeyType::kItems: {
      Json properties = Json::object();
      for (const Key& of : key.items) properties[of.name] = schema_of(of, of.get(key.usual_item));
      out["type"] = "array";
      out["items"] = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
      out["maxItems"] = key.most;
      break;
    }
    case KeyType::kTable:
      out["type"] = "array";
      out["items"] = array(2);
      out["maxItems"] = ForceTable::kMost;
      break;
    case KeyType::kBox: {
      const Json corner = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
      out["type"] = "object";
      out["properties"] = {{"min", corner}, {"max", corner}};
      out["required"] = {"min", "max"};
      out["additionalProperties"] = false;
      break;
    }
  }
  return out;
}

// 1e7, not 10000000 or 1e+07; every digit of a number that six do not hold.
std::string number_text(double value) {
  std::string text = fmt::format("{:g}", value);
  if (std::stod(text) != value) return fmt::format("{}", value);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  return text.substr(0, e + 1) + std::to_string(std::stoi(text.substr(e + 1)));
}

std::string span_text(const Range& range) {
  return (range.above_min ? ">" : "") + number_text(range.min) + ".." + number_text(range.max);
}

std::string default_text(const Json& standard) {
  if (standard.is_number()) return number_text(standard.get<double>());
  return standard.is_string() ? standard.get<std::string>() : standard.dump();
}

// The words of a choice, or the range with its unit and the usual one; the default is bold.
std::string values_of(const Key& key, const Json& standard) {
  const bool none = key.alias || standard.is_null() || standard == Json("") || standard == Json::array();
  const std::string bold = none ? "" : "**" + default_text(standard) + "**";
  std::string out;
  if (key.choices) {
    for (const std::string& word : key.choices())
      out += (out.empty() ? "" : ", ") + (standard == Json(word) ? "**`" + word + "`**" : "`" + word + "`");
    return out;
  }
  const auto add = [&out](const std::string& text, const char* between) {
    if (!text.empty()) out += (out.empty() ? "" : between) + text;
  };
  const bool bounded = std::isfinite(key.range.min) && std::isfinite(key.range.max);
  const bool plain = key.type == KeyType::kText || key.type == KeyType::kNode || key.type == KeyType::kFlag ||
                     key.type == KeyType::kItems;
  add(bold, "");
  if (!plain) add(bounded ? span_text(key.range) : "any", ", ");
  if (key.unit != "1") add(key.unit, " ");
  return std::isfinite(key.usual.min) ? fmt::format("{} ({})", out, span_text(Range{key.usual.min, key.usual.max}))
                                      : out;
}

std::string table_row(const std::string& name, const Key& key, const Json& standard) {
  return fmt::format("`{}` | {} | {}\n", name, values_of(key, standard), key.doc);
}

// An object with this extension at its defaults.
struct Defaults {
  LevelNode node;
  Level level;
  explicit Defaults(const Extension& extension) : owner(extension.on_scene ? static_cast<void*>(&level) : &node) {
    extension.add(owner);
  }
  void* owner;
};

}  // namespace

std::vector<SchemaFile> extension_schemas() {
  std::vector<SchemaFile> files;
  for (const Extension& extension : extension_table()) {
    Defaults defaults(extension);
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "PLIANT_" + extension.name},
                   {"description", extension.doc},
                   {"type", "object"},
                   {"additionalProperties", false}};
    Json& properties = schema["properties"];
    for (const Key& key : extension.keys) {
      const std::size_t dot = key.name.find('.');
      Json& parent = dot == std::string::npos ? properties : properties[key.name.substr(0, dot)]["properties"];
      if (dot != std::string::npos) {
        properties[key.name.substr(0, dot)]["type"] = "object";
        properties[key.name.substr(0, dot)]["additionalProperties"] = false;
      }
      parent[dot == std::string::npos ? key.name : key.name.substr(dot + 1)] = schema_of(key, key.get(defaults.owner));
    }
    properties["extras"] = Json::object();
    properties["extensions"] = {{"type", "object"}};
    files.push_back({"PLIANT_" + extension.name + ".schema.json", schema.dump(2) + "\n"});
  }
  return files;
}

std::string extension_tables() {
  std::string out;
  for (const Extension& extension : extension_table()) {
    Defaults defaults(extension);
    out += fmt::format("### `PLIANT_{}`{}\n\n{}\n\nkey | **default**, values (usual) | meaning\n---|---|---\n",
                       extension.name, extension.on_scene ? " of the scene" : "", extension.doc);
    for (const Key& key : extension.keys) out += table_row(key.name, key, key.get(defaults.owner));
    for (const Key& key : extension.keys)
      for (const Key& of : key.items) out += table_row(key.name + "[]." + of.name, of, of.get(key.usual_item));
    out += "\n";
  }
  return out;
}

}  // namespace pliant
