// Every command shown in a document is accepted by the command line, and runs on a clean clone.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "player/verbs/command_line.h"
#include "tests/player/command.h"

namespace pliant {
namespace {
namespace fs = std::filesystem;

// The words of a shell line: separated by blanks, kept together by quotes, # begins a comment.
std::vector<std::string> words_of_shell(const std::string& line) {
  std::vector<std::string> words;
  bool open = false;
  char quote = '\0';
  for (const char c : line) {
    if (quote != '\0') {
      if (c == quote)
        quote = '\0';
      else
        words.back() += c;
    } else if (c == ' ') {
      open = false;
    } else {
      if (c == '#' && !open) break;
      if (!open) words.emplace_back();
      open = true;
      if (c == '\'' || c == '"')
        quote = c;
      else
        words.back() += c;
    }
  }
  return words;
}

struct ShownCommand {
  std::string where;
  std::vector<std::string> words;
};

// Lines between ``` or indented by four blanks that call the command, by any path or by `./dev run`; `\` at an end
// joins the next line.
std::vector<ShownCommand> commands_of(const fs::path& document) {
  std::vector<ShownCommand> found;
  std::ifstream in(document);
  bool code = false;
  std::string joined;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with("```")) {
      code = !code;
      joined.clear();
      continue;
    }
    if (!code && !line.starts_with("    ")) continue;
    joined += line;
    if (joined.ends_with('\\')) {
      joined.back() = ' ';
      continue;
    }
    std::vector<std::string> words = words_of_shell(joined);
    joined.clear();
    if (words.size() < 2) continue;
    if (fs::path(words[0]).filename() != "pliant" && (words[0] != "./dev" || words[1] != "run")) continue;
    words.erase(words.begin());
    found.push_back({document.filename().string() + ":" + std::to_string(number), std::move(words)});
  }
  return found;
}

// In the order in which they are read: a command may use what an earlier one wrote.
std::vector<fs::path> documents() {
  const fs::path root = PLIANT_SOURCE_DIR;
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  found.insert(found.begin(), {root / "README.md", root / "CHANGELOG.md", root / "content/README.md",
                               root / "bench/results/README.md"});
  return found;
}

TEST(Documents, ShowCommandsThatTheCommandTakes) {
  std::size_t count = 0;
  for (const fs::path& document : documents())
    for (const ShownCommand& shown : commands_of(document)) {
      const Status taken = check_arguments(shown.words);
      EXPECT_TRUE(taken) << shown.where << ": " << (taken ? "" : taken.error().message());
      ++count;
    }
  EXPECT_GT(count, 20u) << "the documents were not found";
}

// Why a command is not run here; empty: it is.
std::string left_out(const ShownCommand& shown) {
  const auto has = [&](const char* part) {
    return std::any_of(shown.words.begin(), shown.words.end(),
                       [&](const std::string& word) { return word.find(part) != std::string::npos; });
  };
  if (shown.where.starts_with("first-level.md")) return "first_level_test.cpp runs it";
  if (shown.words[0] == "edit") return "opens a window";
  if (has("device:") || has("--push")) return "moves a device";
  if (has("--fps") || (shown.words[0] == "fit" && has("hand"))) return "takes half a minute";
  return {};
}

using DocumentCommands = testing::CommandTest;

TEST_F(DocumentCommands, RunOnACleanClone) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "two minutes of runs; the release build has them";
#endif
  fs::create_directory_symlink(fs::path(PLIANT_SOURCE_DIR) / "content", folder / "content");
  std::size_t count = 0;
  for (const fs::path& document : documents())
    for (const ShownCommand& shown : commands_of(document)) {
      if (!left_out(shown).empty()) continue;
      const testing::Said said = pliant(shown.words);
      EXPECT_EQ(said.status, 0) << shown.where << ": " << said.err;
      ++count;
    }
  EXPECT_GT(count, 20u);
}

// Tables and generated lists apart, which are as wide as their cells.
TEST(Documents, HaveNoLineThatIsWiderThanAWindow) {
  constexpr std::size_t kWidest = 180;  // [byte] 160 characters, some of them of several bytes
  for (const fs::path& document : documents()) {
    std::ifstream in(document);
    std::size_t number = 0;
    bool code = false;
    for (std::string line; std::getline(in, line);) {
      ++number;
      code ^= line.starts_with("```");
      if (code || line.find('|') != std::string::npos) continue;
      EXPECT_LE(line.size(), kWidest) << document.filename().string() << ':' << number;
    }
  }
}

TEST(Documents, ACommandWithAnOptionThatIsNotThereWouldBeSeen) {
  EXPECT_FALSE(check_arguments({"run", "--secnds", "2"}));
  EXPECT_FALSE(check_arguments({"touch", "organ.glb"}));
  EXPECT_FALSE(check_arguments({"plot"}));
  EXPECT_TRUE(check_arguments({"sweep", "merge", "out/sweep", "--out", "out/merged"}));
}

}  // namespace
}  // namespace pliant
