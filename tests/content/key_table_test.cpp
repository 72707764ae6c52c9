// The key table defines ranges, defaults, names and docs for files and --set alike.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "content/keys/enum_words.h"
#include "content/keys/extension_table.h"
#include "content/keys/extensions.h"
#include "content/level/varying_keys.h"
#include "content/level_file.h"
#include "systems/touch/model/local_model.h"

namespace pliant::test {
namespace {

const std::string kDocs = PLIANT_SOURCE_DIR "/docs/";

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Otherwise a level could be valid but rejected by a run, or the reverse.
TEST(KeyTable, EveryRangeOfADeformableIsThatOfTheTouchClock) {
  const auto taken = [](const Key& key, double value) {
    LevelNode node;
    node.deformable.emplace().reach = 0.01;
    if (key.name == "friction_sliding") node.deformable->friction_static = kFrictionRange.max;
    if (key.name == "friction_static") node.deformable->friction_sliding = 0.0;
    key.set(&node, value);
    return check(*node.deformable, "thing").ok();
  };
  std::size_t checked = 0;
  for (const Key& key : find_extension("deformable")->keys) {
    if (key.type != KeyType::kNumber && key.type != KeyType::kNumberOrMaterial) continue;
    if (key.name == "young" || key.name == "poisson" || key.name == "thickness" || key.name == "crease_angle" ||
        key.name == "error")
      continue;                                  // converted to a stiffness, a mesh and a shape before the touch clock
    if (key.name == "contact_radius") continue;  // within the reach: touch_shape_test.cpp
    const double below = std::nextafter(key.range.min, -1e30), above = std::nextafter(key.range.max, 1e30);
    if (key.name != "reach") EXPECT_TRUE(taken(key, key.range.min)) << key.name;  // 0: from the object's box
    EXPECT_TRUE(taken(key, key.range.max)) << key.name;
    for (const double outside : {below, above}) {
      EXPECT_FALSE(taken(key, outside)) << key.name << ' ' << outside;
      EXPECT_TRUE(check_value(key, outside)) << key.name << ' ' << outside;
    }
    ++checked;
  }
  EXPECT_EQ(checked, 25u);
}

// A valid value of the key that differs from `other`; no number for a vector, which would be accepted.
Json other_value(const Key& key, const Json& other) {
  const std::vector<Json> candidates{
      0.5,
      1.0,
      20.0,
      0.25,
      0.001,
      !other.is_boolean() || !other.get<bool>(),
      "some text",
      Json::array({0.5, 0.25}),
      Json::array({0.5, 0.25, 0.125}),
      Json::array({Json::array({0.5, 0.25, 0.125})}),
      Json::array({{{"thickness", 0.5}, {"force", 0.25}}}),
      Json::array({Json::array({0.0, 0.0}), Json::array({0.5, 0.25})}),
      Json::array({{{"name", "a"}, {"young", 9}, {"density", 8}, {"damping", 7}}}),
      Json::array({{{"share", 0.5}, {"time", 0.25}}}),
      Json::array({{{"name", "a"}, {"pressure", 9.0}, {"bulk", 8.0}}}),
      Json::parse(R"([{"name": "a", "box": {"min": [0.0, 0.0, 0.0], "max": [0.5, 1.0, 2.0]}}])"),
      Json::parse(R"([{"key": "a", "name": "b", "range": [1.0, 2.0], "step": 0.5}])"),
      {{"min", {0, 0, 0}}, {"max", {0.5, 1, 2}}},
      Json::array({"some text"}),
      !key.choices ? Json() : Json(key.choices().front()),
      !key.choices ? Json() : Json(key.choices().back())};
  for (const Json& each : candidates)
    if (each != other && !check_value(key, each) && each.is_array() == other.is_array()) return each;
  return {};
}

// Each extension's component with its defaults, without the table.
struct Bare {
  LevelNode node;
  Level level;
  Bare() {
    node.deformable = Deformable{};
    node.probe = Probe{};
    node.device = HapticDevice{};
    node.soft_body = SoftBody{};
    node.handle = Handle6{};
    node.rigid_body = RigidBody{};
    node.motion = NodeMotion{};
    node.effect = Effect{};
    node.joint = Joint{};
    level.environment = LevelEnvironment{};
  }
  void* owner(const Extension& extension) { return extension.on_scene ? static_cast<void*>(&level) : &node; }
};

TEST(KeyTable, AKeyThatVariesKeepsItsRange) {
  for (const VaryingKey& each : varying_keys()) {
    const Key* key = find_key(*find_extension(each.of_joint() ? "joint" : "deformable"), each.key);
    ASSERT_NE(key, nullptr) << each.key;
    EXPECT_EQ(each.range.min, key->range.min) << each.key;
    EXPECT_EQ(each.range.max, key->range.max) << each.key;
  }
}

TEST(KeyTable, EveryDefaultIsThatOfTheComponentAndIsValid) {
  for (const SchemaFile& file : extension_schemas()) {
    const Json schema = Json::parse(file.text);
    const Extension& extension = *find_extension(schema["title"].get<std::string>().substr(7));
    Bare bare;
    for (const Key& key : extension.keys) {
      const std::string name = extension.name + "." + key.name;
      const Json component = key.get(bare.owner(extension));
      const bool says_none = component.is_null() || component == "";
      if (!says_none) EXPECT_FALSE(check_value(key, component)) << name;
      std::string pointer = "/properties/" + key.name;
      if (const std::size_t dot = pointer.find('.'); dot != std::string::npos) pointer.replace(dot, 1, "/properties/");
      const Json& documented = schema[Json::json_pointer(pointer)];
      ASSERT_TRUE(documented.is_object()) << name;
      if (says_none || key.alias)
        EXPECT_FALSE(documented.contains("default")) << name;
      else
        EXPECT_EQ(documented["default"], component) << name;
    }
  }
}

// An extension without keys gives the default component, through the reader and through save.
TEST(KeyTable, AnEmptyExtensionIsTheComponentAsItIs) {
  for (const Extension& extension : extension_table()) {
    const Json json{{"PLIANT_" + extension.name, Json::object()}};
    Bare read, bare;
    if (extension.on_scene)
      ASSERT_TRUE(parse_scene_extensions(json, "", read.level).ok());
    else
      ASSERT_TRUE(parse_node_extensions(json, "", {}, read.node).ok());
    for (const Key& key : extension.keys)
      EXPECT_EQ(key.get(read.owner(extension)), key.get(bare.owner(extension))) << extension.name << '.' << key.name;
  }
}

TEST(KeyTable, EveryKeyStandsForAMemberOfItsOwn) {
  for (const Extension& extension : extension_table())
    for (const Key& key : extension.keys) {
      if (key.alias) continue;
      Bare bare;
      std::map<std::string, Json> before;
      for (const Key& each : extension.keys) before[each.name] = each.get(bare.owner(extension));
      const Json value = other_value(key, before[key.name]);
      ASSERT_FALSE(value.is_null()) << extension.name << '.' << key.name;
      key.set(bare.owner(extension), value);
      EXPECT_EQ(key.get(bare.owner(extension)), value) << extension.name << '.' << key.name;
      for (const Key& each : extension.keys)
        if (each.name != key.name && !each.alias)
          EXPECT_EQ(each.get(bare.owner(extension)), before[each.name]) << key.name << " changes " << each.name;
    }
}

TEST(KeyTable, EveryEnumeratorHasAWordOfItsOwn) {
  const auto expect = [](auto last, std::size_t count) {
    using Enum = decltype(last);
    const std::vector<std::string> words = words_of<Enum>();
    ASSERT_EQ(words.size(), count);
    EXPECT_EQ(static_cast<std::size_t>(last), count - 1) << "enumerators count from 0 without a gap";
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(value_of_word<Enum>(words[i]), static_cast<Enum>(i));
    EXPECT_FALSE(value_of_word<Enum>("no such word"));
  };
  expect(SpringLaw::kQuasiLinearTable, 8);
  expect(SphereForce::kSneddon, 2);
  expect(Response::kLag, 2);
  expect(Shape::kKelvinlet, 6);
  expect(Distance::kSurface, 2);
  expect(ProbeMeets::kBodies, 3);
  expect(DriverKind::kExternal, 5);
  expect(Attachment::kSlave, 2);
  expect(ToolForce::kContacts, 3);
  expect(SolverKind::kDense, 6);
  expect(EffectKind::kDetents, 6);
  expect(EffectRegion::kHalfSpace, 4);
  expect(EffectTarget::kPlane, 3);
  expect(DetentAxis::kAround, 2);
}

// --set N.EXT.KEY=TEXT against {"KEY": TEXT} in a file: both accept it or both reject it, with the same result.
TEST(KeyTable, SetTakesWhatAFileTakes) {
  std::size_t taken = 0, refused = 0;
  for (const Extension& extension : extension_table())
    for (const Key& key : extension.keys)
      for (const char* text : {"0",         "-1",
                               "0.3",       "5",
                               "1e9",       "1e300",
                               "true",      "null",
                               "[1, 2]",    "[1, 2, 3]",
                               "[0.5, -1]", "[[0, 0, 1]]",
                               "{}",        "{\"min\": [0, 0, 0], \"max\": [1, 1, 1]}",
                               "material",  "sls",
                               "script",    "orbit",
                               "contacts",  "a.csv",
                               ""}) {
        if (key.type == KeyType::kNode) continue;  // AProbeNamesItsDeviceByNameOrNumber
        const bool is_text = key.type == KeyType::kText || key.type == KeyType::kChoice;
        const Json parsed = Json::parse(text, nullptr, false);
        const Json value = is_text || parsed.is_discarded() ? Json(text) : parsed;
        std::string pointer = "/" + key.name;
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        Json keys;
        keys[Json::json_pointer(pointer)] = value;
        const Json json{{"PLIANT_" + extension.name, keys}};

        Level file, set_level;
        file.nodes.resize(1), set_level.nodes.resize(1);
        file.nodes[0].name = set_level.nodes[0].name = "n";
        const Status read = extension.on_scene ? parse_scene_extensions(json, "", file)
                                               : parse_node_extensions(json, "", {}, file.nodes[0]);
        extension.add(extension.on_scene ? static_cast<void*>(&set_level) : &set_level.nodes[0]);
        const std::string assignment = "n." + extension.name + "." + key.name + "=" + text;
        const Status set = set_key(set_level, assignment);
        ASSERT_EQ(set.ok(), read.ok()) << assignment;
        ++(set ? taken : refused);
        if (!set) continue;
        const Json got = extension.on_scene ? scene_extensions(set_level, {}) : node_extensions(set_level.nodes[0], {});
        EXPECT_EQ(got, extension.on_scene ? scene_extensions(file, {}) : node_extensions(file.nodes[0], {}))
            << assignment;
      }
  EXPECT_GT(taken, 200u);
  EXPECT_GT(refused, 200u);
}

TEST(KeyTable, KeysThatDependOnEachOtherAreSetInAnyOrder) {
  const auto set_all = [](Level& level, std::vector<std::string> assignments) {
    const Status status = set_keys(level, assignments);
    return status ? "" : status.error().message();
  };
  Level level;
  level.nodes.resize(1);
  level.nodes[0].name = "n";
  level.nodes[0].device = HapticDevice{};
  level.nodes[0].deformable = Deformable{};
  EXPECT_NE(set_all(level, {"n.haptic_device.driver=script"}).find("--set n.haptic_device.driver=script: "),
            std::string::npos);
  EXPECT_EQ(level.nodes[0].device->driver, DriverKind::kNull) << "nothing changes";
  EXPECT_EQ(set_all(level, {"n.haptic_device.driver=script", "n.haptic_device.file=a.csv"}), "");
  EXPECT_EQ(level.nodes[0].device->driver, DriverKind::kScript);
  EXPECT_EQ(set_all(level, {"n.deformable.friction_sliding=0.7", "n.deformable.friction_static=0.8"}), "");
  EXPECT_EQ(level.nodes[0].deformable->friction_sliding, 0.7);
  EXPECT_NE(set_all(level, {"n.deformable.friction_static=0.1", "n.deformable.stiffness=7"}), "");
  EXPECT_EQ(level.nodes[0].deformable->friction_static, 0.8);
  EXPECT_NE(level.nodes[0].deformable->stiffness, 7.0);
}

TEST(KeyTable, ANodeIsNamedByItsNameOrItsNumber) {
  Level level;
  level.nodes.resize(3);
  for (LevelNode& node : level.nodes) node.deformable = Deformable{};
  level.nodes[0].name = "1";  // a name has precedence
  ASSERT_TRUE(set_key(level, "1.deformable.stiffness=7").ok());
  ASSERT_TRUE(set_key(level, "2.deformable.stiffness=8").ok());  // of two nodes without a name, the last
  EXPECT_EQ(level.nodes[0].deformable->stiffness, 7.0);
  EXPECT_EQ(level.nodes[1].deformable->stiffness, Deformable{}.stiffness);
  EXPECT_EQ(level.nodes[2].deformable->stiffness, 8.0);
  EXPECT_FALSE(set_key(level, "3.deformable.stiffness=9").ok());
}

TEST(KeyTable, TheSchemasInDocsAreThoseOfTheTable) {
  for (const SchemaFile& schema : extension_schemas()) {
    const std::string path = kDocs + "schemas/" + schema.name;
    if (std::getenv("PLIANT_WRITE_DOCS")) std::ofstream(path) << schema.text;
    EXPECT_EQ(text_of(path), schema.text) << path << ": run this test with PLIANT_WRITE_DOCS=1 to write it anew";
  }
}

TEST(KeyTable, TheTablesOfTheLevelFormatAreThoseOfTheTable) {
  const std::string path = kDocs + "level-format.md", begin = "<!-- keys: begin -->\n", end = "<!-- keys: end -->";
  std::string text = text_of(path);
  const std::size_t from = text.find(begin), to = text.find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos && from < to) << path;
  const std::string wanted = text.substr(0, from + begin.size()) + "\n" + extension_tables() + text.substr(to);
  if (std::getenv("PLIANT_WRITE_DOCS")) std::ofstream(path) << (text = wanted);
  EXPECT_EQ(text, wanted) << path << ": run this test with PLIANT_WRITE_DOCS=1 to write it anew";
}

struct Plain final : SpringFunction {
  double force(double h, const SpringConstants&) const override { return h; }
  double potential(double h, const SpringConstants&) const override { return 0.5 * h * h; }
  double slope(double, const SpringConstants&) const override { return 1.0; }
};

TEST(KeyTable, ALawThatIsRegisteredIsAWordOfItsKey) {
  const Key& key = *find_key(*find_extension("deformable"), "spring");
  EXPECT_TRUE(check_value(key, "plain"));
  ASSERT_TRUE(register_spring("plain", std::make_shared<Plain>()));
  EXPECT_FALSE(check_value(key, "plain"));
  EXPECT_THAT(check_value(key, "plian")->what, testing::HasSubstr("qlv_table, plain"));
  LevelNode node;
  node.deformable.emplace();
  key.set(&node, "plain");
  EXPECT_EQ(key.get(&node), "plain");
}

}  // namespace
}  // namespace pliant::test
