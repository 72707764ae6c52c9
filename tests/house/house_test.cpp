// House rules that a compiler does not check, by reading the sources.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

struct Source {
  std::string path;    // relative to the repository
  std::string folder;  // the first part of it
  std::string text;
};

// Allowed includes per folder. A folder may always include itself.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"include", {}},
    {"runtime", {}},
    {"components", {"runtime"}},
    {"systems", {"runtime", "components", "shaders"}},
    {"content", {"runtime", "components"}},
    {"devices", {"runtime", "components"}},
    {"engine", {"runtime", "components", "systems", "content", "devices"}},
    {"c", {}},
    {"viewer", {"runtime", "components", "systems", "content", "engine", "plot"}},
    {"editor", {"runtime", "components", "systems", "content", "engine", "devices", "plot", "viewer"}},
    {"scenes", {"runtime", "components", "systems", "content"}},
    {"plot", {"runtime"}},
    {"lab", {"runtime", "components", "systems", "content", "devices", "engine", "scenes", "plot"}},
    {"player", {"runtime", "components", "systems", "content", "engine", "devices", "viewer", "editor", "plot", "lab"}},
    {"bench",
     {"runtime", "components", "systems", "content", "engine", "devices", "scenes", "plot", "lab", "player", "editor",
      "tests", "shaders"}},
    {"tests",
     {"runtime", "components", "systems", "content", "engine", "devices", "viewer", "scenes", "plot", "lab", "player",
      "editor", "shaders"}},
    {"examples", {}},
    {"python", {"viewer"}},
    {"fuzz", {"runtime", "components", "systems", "content", "engine", "devices"}},
};

// Rooms within a folder, by the second part of a path (the third for content/gltf), and those that each may include.
// A room that is not listed may include all of its folder.
const std::map<std::string, std::set<std::string>> kRooms{
    {"systems/safety", {}},
    {"systems/touch", {"systems/safety"}},
    {"systems/effects", {"systems/safety", "systems/touch"}},
    {"systems/soft", {"systems/safety", "systems/touch"}},
    {"systems/tool", {"systems/safety", "systems/touch", "systems/soft"}},
    {"systems/device", {"systems/safety", "systems/touch", "systems/effects", "systems/soft", "systems/tool"}},
    {"systems/visual", {"systems/touch"}},
    {"content/gltf/form", {}},
    {"content/gltf/check", {"content/gltf/form"}},
    {"content/gltf/read", {"content/gltf/form", "content/gltf/check"}},
    {"content/gltf/write", {"content/gltf/form", "content/gltf/check", "content/gltf/read"}},
    {"content/mesh", {"content/level"}},
    {"content/tets", {"content/level", "content/mesh", "content/files"}},
    {"content/level", {"content/mesh", "content/tets", "content/files"}},
    {"engine/run", {}},
    {"engine/choice", {}},
    {"engine/session", {"engine/run", "engine/choice"}},
    {"engine/picture", {"engine/session"}},
    {"lab/console", {}},
    {"lab/files", {"lab/console"}},
    {"lab/study", {"lab/console", "lab/files"}},
    {"lab/sweep", {"lab/console", "lab/files", "lab/study"}},
    {"lab/plot", {"lab/console", "lab/files", "lab/study"}},
    {"lab/fit", {"lab/console", "lab/files", "lab/study", "lab/plot", "lab/sweep"}},
    {"viewer/window", {}},
    {"viewer/hand", {}},
    {"viewer/picture", {}},
    {"viewer/ui", {"viewer/window"}},
    {"player/record", {}},
    {"player/run", {"player/record"}},
    {"player/window", {"player/record", "player/run"}},
    {"player/level", {"player/record", "player/run", "player/window"}},
    {"editor/ui", {}},
    {"editor/paint", {}},
    {"editor/document", {"editor/paint"}},
    {"editor/viewport", {"editor/document"}},
    {"editor/core", {"editor/document", "editor/paint", "editor/viewport"}},
    {"editor/budget", {"editor/core", "editor/document"}},
    {"editor/play", {"editor/core", "editor/document", "editor/viewport"}},
    {"editor/app",
     {"editor/core", "editor/document", "editor/edit.h", "editor/paint", "editor/play", "editor/ui",
      "editor/viewport"}},
    {"editor/tools", {"editor/app", "editor/core", "editor/document", "editor/paint", "editor/ui", "editor/viewport"}},
    {"editor/panels",
     {"editor/app", "editor/budget", "editor/core", "editor/document", "editor/paint", "editor/play", "editor/tools",
      "editor/ui", "editor/viewport"}},
    {"devices/ports", {}},
    {"devices/guard", {}},
    {"devices/simulated", {"devices/pose_file.h", "devices/spec.h"}},
    {"devices/wrappers", {"devices/drop_counter.h", "devices/pose_file.h", "devices/spec.h"}},
    {"devices/servo", {"devices/guard", "devices/drop_counter.h", "devices/spec.h"}},
};

// "systems/touch" of "systems/touch/model/dent.h", "content/gltf/check" of "content/gltf/check/gltf_check.h".
std::string room_of(const std::string& path) {
  const std::size_t second = path.find('/', path.find('/') + 1);
  if (second == std::string::npos) return path;
  const std::string inner = path.substr(0, path.find('/', second + 1));
  return kRooms.count(inner) ? inner : path.substr(0, second);
}

// "systems/" of "systems/touch", "content/gltf/" of "content/gltf/check".
std::string parent_of(const std::string& room) {
  return room.substr(0, room.rfind('/') + 1);
}

const std::vector<Source>& sources() {
  static const std::vector<Source> all = [] {
    std::vector<Source> found;
    const fs::path root = PLIANT_SOURCE_DIR;
    for (const auto& [folder, ignored] : kMayInclude) {
      if (!fs::exists(root / folder)) continue;
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
        std::ifstream in(entry.path());
        std::stringstream text;
        text << in.rdbuf();
        found.push_back({fs::relative(entry.path(), root).generic_string(), folder, text.str()});
      }
    }
    return found;
  }();
  return all;
}

// A program goes by codes (docs/codes.md): the words of an error, finding or note are for people, and change.
TEST(House, NoSourceLooksIntoASentence) {
  const std::regex search(
      R"(\b(message|sentence|what|cure)(\(\))?\s*\.\s*(find|rfind|starts_with|ends_with|contains|compare|substr)\s*\()"
      R"(|find\(\s*"; ")");
  // Libraries whose exceptions have words and nothing else; their words are shortened, not understood.
  const std::set<std::string> third_party{"content/files/exr.cpp", "content/gltf/form/gltf_container.cpp",
                                          "player/verbs/command_line.cpp"};
  EXPECT_TRUE(std::regex_search(std::string("if (error.what.find(\"x\") == 0)"), search));
  EXPECT_TRUE(std::regex_search(std::string("text.find(\"; \")"), search));
  EXPECT_TRUE(std::regex_search(std::string("each.message().starts_with(a)"), search));
  std::size_t checked = 0;
  for (const Source& source : sources()) {
    if (source.folder == "tests" || third_party.count(source.path)) continue;
    std::smatch found;
    EXPECT_FALSE(std::regex_search(source.text, found, search))
        << source.path << " looks into words: " << found.str() << "...; go by a code";
    ++checked;
  }
  EXPECT_GT(checked, 50u) << "the sources were not found";
}

// Codes are of one form, so that a search finds each, and are in the list. The window and the editor name actions so.
TEST(House, EveryCodeIsInTheDocument) {
  std::ifstream in(fs::path(PLIANT_SOURCE_DIR) / "docs/codes.md");
  std::stringstream text;
  text << in.rdbuf();
  const std::string document = text.str();
  const std::regex code(
      R"re("((?:disk|dropped|file|force|gltf|key|level|limit|mesh|name|panorama|run|script|soft|surface|tets|tissue|tool|torque|device)\.[a-z_]+)")re");
  std::size_t found = 0;
  for (const Source& source : sources()) {
    if (source.folder != "content" && source.folder != "engine" && source.folder != "components" &&
        source.folder != "devices" && (source.folder != "player" || source.path.starts_with("player/window/")))
      continue;
    for (std::sregex_iterator at(source.text.begin(), source.text.end(), code), end; at != end; ++at) {
      const std::string name = (*at)[1], family = name.substr(0, name.find('.'));
      EXPECT_TRUE(document.find('`' + name + '`') != std::string::npos ||
                  document.find("`." + name.substr(family.size() + 1) + '`') != std::string::npos)
          << source.path << ": " << name << " is not in docs/codes.md";
      ++found;
    }
  }
  EXPECT_GT(found, 50u);
}

TEST(House, EveryIncludePointsTowardsTheFoundation) {
  const std::regex include("(?:^|\\n)#include\\s+\"([^\"]+)\"");
  std::size_t checked = 0;
  for (const Source& source : sources()) {
    for (std::sregex_iterator at(source.text.begin(), source.text.end(), include), end; at != end; ++at) {
      const std::string target = (*at)[1];
      if (target.ends_with(".glsl") && target.find('/') == std::string::npos) continue;  // shader text in a string
      if (target.starts_with("pliant/")) {                                               // public, for all
        EXPECT_TRUE(fs::exists(fs::path(PLIANT_SOURCE_DIR) / "include" / target)) << source.path << ": " << target;
        continue;
      }
      const std::string folder = target.substr(0, target.find('/'));
      EXPECT_TRUE(folder == source.folder || kMayInclude.at(source.folder).count(folder))
          << source.path << " may not include \"" << target << '"';
      EXPECT_TRUE(fs::exists(fs::path(PLIANT_SOURCE_DIR) / target))
          << source.path << ": \"" << target << "\" is not a path from the repository's root";
      ++checked;
    }
  }
  EXPECT_GT(checked, 50u) << "the sources were not found";
}

TEST(House, EveryRoomIncludesOnlyThoseBelowIt) {
  const std::regex include("(?:^|\\n)#include\\s+\"([^\"]+)\"");
  std::size_t checked = 0;
  for (const Source& source : sources()) {
    const auto room = kRooms.find(room_of(source.path));
    if (room == kRooms.end()) continue;
    for (std::sregex_iterator at(source.text.begin(), source.text.end(), include), end; at != end; ++at) {
      const std::string target = room_of((*at)[1]);
      if (target == room->first || !target.starts_with(parent_of(room->first))) continue;
      EXPECT_TRUE(room->second.count(target)) << source.path << " may not include \"" << (*at)[1] << '"';
      ++checked;
    }
  }
  EXPECT_GT(checked, 50u) << "the rooms were not found";
}

// Two types with the same name in one program violate the one-definition rule. A type used by a single file belongs in
// an unnamed namespace, where its name is free.
TEST(House, EveryTypeThatIsNotAFilesOwnHasANameOfItsOwn) {
  const std::regex type(
      "^(?:struct|class|enum class|enum) (?:alignas\\([^)]*\\) )?(\\w+)(?: final)?(?: :[^:;].*| \\{.*)$");
  std::map<std::string, std::string> where;
  for (const Source& source : sources()) {
    if (source.folder == "tests" || source.folder == "bench" || source.folder == "examples" || source.folder == "fuzz")
      continue;  // each of their files is practically a separate program
    std::istringstream lines(source.text);
    bool own = false;
    std::string space;  // "" is namespace pliant
    for (std::string line; std::getline(lines, line);) {
      if (line == "namespace {") own = true;
      if (line == "}  // namespace") own = false;
      if (line.starts_with("namespace ") && line != "namespace {" && line != "namespace pliant {") space = line;
      if (!space.empty() && line == "}  // " + space.substr(0, space.find(" {"))) space.clear();
      std::smatch found;
      if (own || !std::regex_match(line, found, type)) continue;
      const auto [it, fresh] = where.emplace(space + found[1].str(), source.path);
      EXPECT_TRUE(fresh) << found[1] << " is in " << it->second << " and in " << source.path;
    }
  }
  EXPECT_GT(where.size(), 200u) << "the types were not found";
}

TEST(House, EveryHeaderIsReadOnce) {
  for (const Source& source : sources()) {
    if (source.path.ends_with(".h")) {
      EXPECT_NE(source.text.find("#pragma once\n"), std::string::npos) << source.path;
    }
  }
}

TEST(House, EveryFileOpensWithWhatItIsFor) {
  for (const Source& source : sources()) {
    if (source.path.ends_with(".h")) {
      EXPECT_TRUE(source.text.starts_with("//")) << source.path;
    }
  }
}

// Split so that this file does not contain them.
TEST(House, NoFileSpeaksOfAMachineOrOfUnfinishedWork) {
  const std::vector<std::string> strangers{
      std::string("/ho") + "me/", std::string("/wo") + "rk/", std::string("/ro") + "ot/", std::string("/mn") + "t/",
      std::string("TO") + "DO",   std::string("FIX") + "ME",  std::string("XX") + "X"};
  for (const Source& source : sources())
    for (const std::string& stranger : strangers)
      EXPECT_EQ(source.text.find(stranger), std::string::npos) << source.path << " holds " << stranger;
}

// Sentences of all comments: lines of // that follow each other are one text.
std::vector<std::string> comments_of(const Source& source) {
  std::vector<std::string> found;
  std::istringstream lines(source.text);
  bool open = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find_first_not_of(" \t");
    const std::size_t mark = line.find("// ");
    const bool whole = at != std::string::npos && mark == at;
    if (mark == std::string::npos || (!whole && line.find('"') != std::string::npos)) {
      open = false;
      continue;
    }
    if (whole && open)
      found.back() += ' ' + line.substr(mark + 3);
    else
      found.push_back(line.substr(mark + 3));
    open = whole;
  }
  return found;
}

// The field's words (subject, verb, object): riddles and persons that the sources had, kept from coming back.
TEST(House, CommentsAreInPlainWords) {
  struct Habit {
    std::string name;
    std::regex pattern;
    std::size_t most;
    std::size_t count = 0;
  };
  std::vector<Habit> habits{{"a sentence that opens with What, Who, Whoever or Whatever",
                             std::regex("(?:^|[.:;] )Wh(?:at|o)(?:ever)?\\b"), 18},
                            {"no" + std::string("body"), std::regex("\\bno" + std::string("body\\b")), 2},
                            {"is t" + std::string("old"), std::regex("\\bis t" + std::string("old\\b")), 0},
                            {"gives w" + std::string("ay"), std::regex("\\bgives? w" + std::string("ay\\b")), 0},
                            {"is no, beside is no longer", std::regex("\\bis no\\b(?! longer)"), 40}};
  std::size_t comments = 0;
  for (const Source& source : sources())
    for (const std::string& comment : comments_of(source)) {
      ++comments;
      for (Habit& habit : habits)
        habit.count += static_cast<std::size_t>(
            std::distance(std::sregex_iterator(comment.begin(), comment.end(), habit.pattern), std::sregex_iterator()));
    }
  EXPECT_GT(comments, 5000u) << "the comments were not found";
  for (const Habit& habit : habits) EXPECT_LE(habit.count, habit.most) << habit.name;
}

// Names, too: a device is requested, a motion prescribed, a fault reported.
TEST(House, NamesAreInTheFieldsWords) {
  const std::regex habit(std::string("[Ww]is") + "h|\\b" + "tol" + "d|_tol" + "d|[a-z]Tol" + "d|\\bTol" + "d");
  for (const std::string& word : {std::string("device_wis") + "hes()", std::string("IsTol") + "dSo"})
    EXPECT_TRUE(std::regex_search(word, habit)) << word;
  for (const Source& source : sources()) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(source.text, found, habit))
        << source.path << ": " << found.suffix().str().substr(0, 20);
  }
}

}  // namespace
