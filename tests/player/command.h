// Runs the real binary and captures its output; small meshes and scripts for it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace pliant::testing {
namespace fs = std::filesystem;
using Json = nlohmann::json;

inline std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}
inline void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

struct Said {
  int status = -1;
  std::string out, err;
};

// A separate folder for every test, removed afterwards.
class CommandTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("pliant-") + info->test_suite_name() + "-" + info->name();
    for (char& c : name)
      if (c == '/') c = '-';
    folder = fs::temp_directory_path() / (name + "-" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  static std::string quoted(const std::string& word) {
    std::string text = "'";
    for (char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
  }

  // Runs in this test's folder. `before`: a shell prefix of the command.
  Said pliant(const std::vector<std::string>& arguments, const std::string& before = {},
              const std::string& program = PLIANT_BINARY) const {
    // Without a display, so that no window opens on a desktop; `before` may set one.
    std::string line =
        "cd " + quoted(folder.string()) + " && env -u DISPLAY -u WAYLAND_DISPLAY " + before + " " + quoted(program);
    for (const std::string& argument : arguments) line += " " + quoted(argument);
    line += " >.out 2>.err";
    const int status = std::system(line.c_str());
    Said said{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(folder / ".out"),
              read_text(folder / ".err")};
    fs::remove(folder / ".out");
    fs::remove(folder / ".err");
    return said;
  }

  // Expects this exit status, one line on stderr of the documented form, and no new file.
  void expect_refused(const std::vector<std::string>& arguments, int status, const std::string& word) const {
    std::string line;
    for (const std::string& argument : arguments) line += " " + argument;
    const std::size_t before = count_files();
    const Said said = pliant(arguments);
    EXPECT_EQ(said.status, status) << line << '\n' << said.err;
    std::string error;
    std::istringstream lines(said.err);
    for (std::string each; std::getline(lines, each);) {
      if (each.starts_with("pliant: note: ")) continue;
      EXPECT_TRUE(error.empty()) << line << ": more than one line of error: " << said.err;
      error = each;
    }
    EXPECT_TRUE(error.starts_with("pliant: error: ")) << line << '\n' << said.err;
    EXPECT_NE(error.find("; "), std::string::npos) << line << ": does not say what to do: " << error;
    EXPECT_NE(error.find(word), std::string::npos) << line << ": does not speak of " << word << ": " << error;
    EXPECT_EQ(count_files(), before) << line << ": something was written";
  }

  std::size_t count_files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder)) ++count;
    return count;
  }

  Json report(const std::string& out) const { return Json::parse(read_text(folder / out / "report.json")); }

  fs::path folder;
};

// A flat square of side 0.1 m in y = 0, n x n quads, counter-clockwise seen from above.
inline std::string plate_obj(int n = 40) {
  std::ostringstream obj;
  obj << "o plate\n";
  for (int z = 0; z <= n; ++z)
    for (int x = 0; x <= n; ++x) obj << "v " << 0.1 * x / n - 0.05 << " 0 " << 0.1 * z / n - 0.05 << '\n';
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) {
      const int a = z * (n + 1) + x + 1, b = a + 1, c = a + n + 1, d = c + 1;
      obj << "f " << a << ' ' << c << ' ' << d << '\n' << "f " << a << ' ' << d << ' ' << b << '\n';
    }
  return obj.str();
}

// Down to `depth` [m] below y = 0 in half a second, a slide of 1 cm in the next second, up again in half a second.
inline std::string press_csv(double depth) {
  std::ostringstream csv;
  csv << "time_s,x,y,z\n0,0,0.01,0\n0.5,0,-" << depth << ",0\n0.7,0,-" << depth << ",0\n1.2,0.01,-" << depth
      << ",0\n1.5,0.01,0.01,0\n";
  return csv.str();
}

// forces.csv as rows by column name.
struct ForcesTable {
  std::vector<std::string> columns;
  std::vector<std::map<std::string, std::string>> rows;
  double number(std::size_t row, const std::string& column) const { return std::stod(rows[row].at(column)); }
};
inline ForcesTable read_forces(const fs::path& file) {
  ForcesTable table;
  std::ifstream in(file);
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    return cells;
  };
  std::string line;
  std::getline(in, line);
  table.columns = split(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < cells.size() && i < table.columns.size(); ++i) row[table.columns[i]] = cells[i];
    if (cells.size() == table.columns.size()) table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace pliant::testing
