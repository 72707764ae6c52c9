// Checks values of keys, and words the errors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "content/keys/extension_table.h"
#include "runtime/assert.h"

namespace pliant {

namespace {

constexpr double kDegree = 0.017453292519943295;  // [rad]

bool numbers(const Json& value, std::size_t count, const Range& range) {
  if (!value.is_array() || value.size() != count) return false;
  for (const Json& each : value)
    if (!each.is_number() || !range.holds(each.get<double>())) return false;
  return true;
}

struct Prefixed {
  const char* unit;
  const char* meant;
  double factor;
};
// Common units of quantities that keys have in SI units.
constexpr Prefixed kMeant[] = {
    {"Pa", "kPa", 1e3},          {"Pa", "MPa", 1e6},      {"m", "mm", 1e-3},       {"m", "cm", 1e-2}, {"s", "ms", 1e-3},
    {"rad", "degrees", kDegree}, {"N/m", "N/mm", 1e3},    {"kg/m3", "g/cm3", 1e3}, {"kg", "g", 1e-3}, {"N", "mN", 1e-3},
    {"Hz", "kHz", 1e3},          {"m/s2", "cm/s2", 1e-2}, {"N m", "N mm", 1e-3}};

// "kPa meant? then write 5000", if that would be a usual value.
std::string unit_question(const Key& key, double value) {
  if (!std::isfinite(key.usual.min)) return "";
  for (const Prefixed& each : kMeant)
    if (key.unit == each.unit && key.usual.holds(value * each.factor) && key.range.holds(value * each.factor))
      return fmt::format("{} meant? then write {:.6g}", each.meant, value * each.factor);
  return "";
}

// Truncates a word for an error message.
std::string cut(const std::string& word) {
  return word.substr(0, 100);
}

// A note on a key of an item, as one on the list.
Note in_item(const Key& list, std::size_t i, const Key& of, Note note) {
  note.what = fmt::format("item {}: `{}` {}", i + 1, of.name, note.what);
  note.of = list.name;
  return note;
}

// The fault of a list of objects.
std::optional<Note> check_items(const Key& key, const Json& value) {
  const auto fault = [&](std::string what, std::string cure = {}) {
    return Note{std::move(what), std::move(cure), "key.value", key.name};
  };
  if (!value.is_array() || value.size() > key.most)
    return fault(fmt::format("must be a list of at most {} objects", key.most));
  std::vector<std::string> names;
  for (const Key& of : key.items) names.push_back(of.name);
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_object()) return fault(fmt::format("item {} must be an object", i + 1));
    for (const auto& [name, each] : value[i].items()) {
      const auto of = std::find_if(key.items.begin(), key.items.end(),
                                   [&known = name](const Key& item) { return item.name == known; });
      if (of == key.items.end()) {
        Note wrong = unknown("key", name, fmt::format("item {} of {}", i + 1, key.name), "keys", names);
        wrong.of = key.name;
        return wrong;
      }
      if (std::optional<Note> wrong = check_value(*of, each)) return in_item(key, i, *of, *wrong);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string usual_text(const Key& key) {
  if (!std::isfinite(key.usual.min)) return "";
  return fmt::format("{:g} to {:g}", key.usual.min, key.usual.max);
}

std::optional<Note> doubt(const Key& key, const Json& value) {
  if (key.type == KeyType::kItems) {
    for (std::size_t i = 0; i < value.size(); ++i)
      for (const Key& of : key.items)
        if (!value[i].contains(of.name))
          continue;
        else if (std::optional<Note> found = doubt(of, value[i][of.name]))
          return in_item(key, i, of, *found);
    return std::nullopt;
  }
  if (value.is_array()) {
    for (const Json& each : value)
      if (std::optional<Note> found = doubt(key, each)) return found;
    return std::nullopt;
  }
  if (!value.is_number() || value == 0 || key.usual.holds(value.get<double>())) return std::nullopt;
  const std::string unit = key.unit.empty() || key.unit == "1" ? "" : " " + key.unit;
  return Note{fmt::format("is {:g}{}, which is unusual ({}{})", value.get<double>(), unit, usual_text(key), unit),
              unit_question(key, value.get<double>()), "key.unusual", key.name};
}

std::string range_text(const Key& key) {
  const bool low = std::isfinite(key.range.min), high = std::isfinite(key.range.max);
  if (!low && !high) return "any";
  return fmt::format("{}{}, {}", key.range.above_min ? "(" : "[", key.range.min, key.range.max) + (high ? "]" : ")");
}

std::optional<Note> check_value(const Key& key, const Json& value) {
  const std::optional<Note> fine;
  const auto fault = [&](std::string what, std::string cure = {}) -> std::optional<Note> {
    return Note{std::move(what), std::move(cure), "key.value", key.name};
  };
  const auto number = [&] {
    const double it = value.get<double>();
    if (key.whole && key.range.holds(it) && it != std::floor(it))
      return fault("must be a whole number; got " + value.dump());
    if (key.range.holds(it)) return fine;
    return fault(fmt::format("must be in the range {}{}; got {}", range_text(key),
                             key.unit.empty() || key.unit == "1" ? "" : " " + key.unit, value.dump()),
                 unit_question(key, it));
  };
  const std::string given = value.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 60);
  const auto must_be = [&](const std::string& what) { return fault("must be " + what + "; got " + given); };
  switch (key.type) {
    case KeyType::kNumber:
      return value.is_number() ? number() : must_be("a number");
    case KeyType::kNumberOrMaterial:
      if (value == "material") return fine;
      return value.is_number() ? number() : must_be("a number or \"material\"");
    case KeyType::kFlag:
      return value.is_boolean() ? fine : must_be("true or false");
    case KeyType::kText:
    case KeyType::kNode:
      return value.is_string() ? fine : must_be("a text");
    case KeyType::kChoice: {
      std::string all;
      for (const std::string& each : key.choices()) {
        if (value == each) return fine;
        all += (all.empty() ? "" : ", ") + each;
      }
      return fault("must be one of " + all + "; got " +
                   (value.is_string() ? "'" + cut(value.get<std::string>()) + "'" : given));
    }
    case KeyType::kColor:
      return numbers(value, 3, key.range) ? fine : must_be("three numbers in " + range_text(key));
    case KeyType::kPair:
      return numbers(value, 2, key.range) ? fine : must_be("two numbers in " + range_text(key));
    case KeyType::kVector:
      if (value.is_number()) return number();
      return numbers(value, 3, key.range) ? fine : must_be("three numbers in " + range_text(key));
    case KeyType::kPoints: {
      const bool good =
          value.is_array() && value.size() <= kMostPoints &&
          std::all_of(value.begin(), value.end(), [&](const Json& each) { return numbers(each, 3, key.range); });
      return good ? fine : must_be(fmt::format("a list of at most {} points [x, y, z]", kMostPoints));
    }
    case KeyType::kNames: {
      const bool good =
          value.is_array() && value.size() <= kMostNames &&
          std::all_of(value.begin(), value.end(), [](const Json& each) { return each.is_string() && each != ""; });
      return good ? fine : must_be(fmt::format("a list of at most {} names", kMostNames));
    }
    case KeyType::kTable: {
      const bool good =
          value.is_array() && value.size() <= ForceTable::kMost && value.size() != 1 &&
          std::all_of(value.begin(), value.end(), [&](const Json& each) { return numbers(each, 2, key.range); });
      return good ? fine
                  : must_be(
                        fmt::format("a list of 2 to {} rows [depth, force] in {}", ForceTable::kMost, range_text(key)));
    }
    case KeyType::kBox: {
      const Range any{-1e6, 1e6};
      bool good = value.is_object() && value.size() == 2 && value.contains("min") && value.contains("max") &&
                  numbers(value["min"], 3, any) && numbers(value["max"], 3, any);
      for (std::size_t i = 0; good && i < 3; ++i) good = value["min"][i].get<double>() <= value["max"][i].get<double>();
      return good ? fine : must_be("a box {\"min\": [x, y, z], \"max\": [x, y, z]}");
    }
    case KeyType::kItems:
      return check_items(key, value);
  }
  UNREACHABLE();
}

std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = 1 + std::min<std::size_t>(3, word.size() / 2);
  for (const std::string& name : names) {
    // Edit distance: letters changed, added, removed or swapped with their neighbour (optimal string alignment), row by
    // row.
    std::vector<std::size_t> row(name.size() + 1), before, before_that;
    for (std::size_t j = 0; j <= name.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= std::min<std::size_t>(word.size(), 64); ++i) {
      before_that = std::exchange(before, row);
      row[0] = i;
      for (std::size_t j = 1; j <= name.size(); ++j) {
        const std::size_t kept = before[j - 1] + (word[i - 1] == name[j - 1] ? 0 : 1);
        row[j] = std::min({kept, before[j] + 1, row[j - 1] + 1});
        if (i > 1 && j > 1 && word[i - 1] == name[j - 2] && word[i - 2] == name[j - 1])
          row[j] = std::min(row[j], before_that[j - 2] + 1);
      }
    }
    if (row.back() < least) {
      least = row.back();
      best = name;
    }
  }
  return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string near = nearest(word, names);
  return near.empty() ? "" : "did you mean " + near + "?";
}

Note unknown(const std::string& what, const std::string& word, const std::string& in, const std::string& all,
             const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 40;  // a scene may have a hundred nodes
  const std::string near = suggestion(word, names);
  const auto last = names.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, names.size()));
  return {fmt::format("unknown {} '{}'{}{}", what, cut(word), in.empty() ? "" : " in ", in),
          near.empty() ? fmt::format("{} are: {}{}", all, fmt::join(names.begin(), last, ", "),
                                     names.size() > kNamed ? " and others" : "")
                       : near,
          "name.unknown", word};
}

Note unknown_key(const Extension& extension, const std::string& word) {
  std::vector<std::string> names;
  for (const Key& key : extension.keys) names.push_back(key.name);
  return unknown("key", word, "PLIANT_" + extension.name, "keys", names);
}

}  // namespace pliant
