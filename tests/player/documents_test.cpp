// Every command shown in a document is accepted by the command line.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "player/verbs/command_line.h"

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

// Lines between ``` that call the command, by any path; `\` at an end joins the next line.
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
    if (!code) continue;
    joined += line;
    if (joined.ends_with('\\')) {
      joined.back() = ' ';
      continue;
    }
    std::vector<std::string> words = words_of_shell(joined);
    joined.clear();
    if (words.size() < 2 || fs::path(words[0]).filename() != "pliant") continue;
    words.erase(words.begin());
    found.push_back({document.filename().string() + ":" + std::to_string(number), std::move(words)});
  }
  return found;
}

TEST(Documents, ShowCommandsThatTheCommandTakes) {
  const fs::path root = PLIANT_SOURCE_DIR;
  std::vector<fs::path> documents{root / "README.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") documents.push_back(entry.path());
  std::size_t count = 0;
  for (const fs::path& document : documents)
    for (const ShownCommand& shown : commands_of(document)) {
      const Status taken = check_arguments(shown.words);
      EXPECT_TRUE(taken) << shown.where << ": " << (taken ? "" : taken.error().message());
      ++count;
    }
  EXPECT_GT(count, 20u) << "the documents were not found";
}

// Tables and generated lists apart, which are as wide as their cells.
TEST(Documents, HaveNoLineThatIsWiderThanAWindow) {
  constexpr std::size_t kWidest = 180;  // [byte] 160 characters, some of them of several bytes
  const fs::path root = PLIANT_SOURCE_DIR;
  std::vector<fs::path> documents{root / "README.md", root / "CHANGELOG.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") documents.push_back(entry.path());
  for (const fs::path& document : documents) {
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
