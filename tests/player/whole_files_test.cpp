// Files for spreadsheets, runs that end early, two writers of one file: nothing is evaluated, lost or incomplete.
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "lab/files/csv.h"
#include "lab/sweep/lines.h"
#include "player/verbs/command_line.h"
#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

const std::vector<std::string> kFormulas = {"=1+1", "+x",      "-x",     "@SUM(A1)", "=cmd|'/c calc'!A1",
                                            "  =1", "'=1",     "''-a",   "a;=b",     "--rate",
                                            "-",    "\uFF1D1", "\"=1\"", "=1,=2\"=3"};

// True if a spreadsheet would evaluate the cell.
bool is_evaluated(const std::string& cell) {
  const std::size_t begin = cell.find_first_not_of(" \t\r");
  if (begin == std::string::npos || !std::strchr("=+-@", cell[begin])) return false;
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return *end != '\0';
}

TEST(CsvText, NoCellIsAFormulaAndEveryNameIsReadBack) {
  for (const std::string& name : kFormulas) {
    const std::string cell = csv_text(name);
    std::string inside = cell[0] == '"' ? cell.substr(1) : cell;
    EXPECT_FALSE(is_evaluated(inside)) << cell;
    std::vector<std::string> cells;
    csv_cells("1," + cell + ",2", ',', cells);
    ASSERT_EQ(cells.size(), 3u) << cell;
    EXPECT_EQ(cells[1], name);
  }
  for (const char* plain : {"-5", "+1e3", "-.25", "1e-7", "tip", "a-b", "it's", "'quoted'", ""})
    EXPECT_EQ(csv_text(plain), plain);
}

class WholeFiles : public Sweep {
 protected:
  void expect_no_formulas(const fs::path& below) const {
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(below)) {
      if (entry.path().extension() != ".csv") continue;
      ++files;
      std::istringstream in(read_text(entry.path()));
      for (std::string line; std::getline(in, line);) {
        std::string cell;
        bool quoted = false;
        for (const char c : line + ",") {
          if (c == '"') {
            quoted = !quoted;
          } else if (c == ',' && !quoted) {
            EXPECT_FALSE(is_evaluated(cell)) << entry.path() << ": " << cell;
            cell.clear();
          } else {
            cell += c;
          }
        }
      }
    }
    EXPECT_GT(files, 0) << below;
  }
  bool anything_staged() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().filename().string().find(".part") != std::string::npos) return true;
    return false;
  }
  // Starts the command, sends the signal once a staged folder exists, waits, and returns the status.
  int interrupted(const std::string& command, const std::string& out, const char* signal) const {
    write_text(folder / "end.sh",
               "cd " + quoted(folder.string()) + "\n(trap - INT TERM; exec " + quoted(PLIANT_BINARY) + " " + command +
                   " >/dev/null 2>.said) &\npid=$!\n" + "until [ -e " + out +
                   "/.partial-$pid ]; do kill -0 $pid || exit 99; done\nkill -" + signal + " $pid; wait $pid\n");
    return WEXITSTATUS(std::system(("bash " + quoted((folder / "end.sh").string()) + " 2>/dev/null").c_str()));
  }
};

TEST_F(WholeFiles, NamesOfProbesNodesAndAxesAreNoFormulas) {
  std::string obj = plate_obj(6);
  write_text(folder / "plate.obj", obj.replace(obj.find("plate"), 5, "=1+1"));
  for (const char* out : {"a", "b"})
    ASSERT_EQ(pliant({"run", "plate.obj", "--probe", "+x=script:press.csv", "--probe", "@y=orbit", "--seconds", "0.1",
                      "--frames", "0", "--out", out})
                  .status,
              0);
  const Said plotted = pliant({"plot", "a", "b", "--probe", "+x", "--out", "plot"});
  EXPECT_EQ(plotted.status, 0) << plotted.err;
  EXPECT_NE(plotted.out.find("a: +x"), std::string::npos) << plotted.out;
  write_text(folder / "plan.json", R"({"level": "plate.obj", "options": {"seconds": 0.05}, "axes": {"--probe":
      ["+x=script:press.csv", "@y=script:press.csv"], "--rate": [500, 1000]}})");
  ASSERT_EQ(sweep().status, 0);
  ASSERT_EQ(pliant({"sweep", "merge", "out", "--out", "m"}).status, 0);
  for (const char* each : {"a", "plot", "m"}) expect_no_formulas(folder / each);
}

TEST_F(WholeFiles, AMergeOrAPlotThatIsEndedLeavesNothing) {
  write_plan(R"("latin_hypercube": {"runs": 3000, "seed": 1, "axes": {"*.deformable.stiffness": {"from": 1, "to": 2},
      "*.deformable.reach": {"from": 0.01, "to": 0.02}, "*.deformable.cubic": {"from": 0, "to": 1}}})");
  const auto plan = read_plan(folder / "plan.json", check_run_arguments);
  ASSERT_TRUE(plan);
  ExpandedPlan all;
  std::string text;
  for (std::size_t i = 0; i < plan->count(); ++i) {
    all.runs.push_back({std::to_string(i), plan->values_of(i), {}});
    Json figures;
    for (int f = 0; f < 20; ++f) figures["f" + std::to_string(f)] = std::sin(static_cast<double>(i * (f + 1)));
    text += Json{{"id", std::to_string(i)},
                 {"status", "done"},
                 {"axes", Json::object()},
                 {"timing", Json::object()},
                 {"figures", figures}}
                .dump() +
            "\n";
  }
  fs::create_directories(folder / "lines");
  write_text(folder / "lines" / "sweep.json", sweep_json(*plan, all));
  write_text(folder / "lines" / "runs-1-of-1.jsonl", text);
  std::string rows = "tick,time_s,probe,in_contact,object,depth_m,fn,ft\n";
  for (int i = 0; i < 200000; ++i)
    rows += std::to_string(i) + "," + std::to_string(i * 1e-3) + ",tip,1,plate,0.00" + std::to_string(i % 9) + ",0." +
            std::to_string(i % 7) + ",0\n";
  write_text(folder / "forces.csv", rows);
  for (const char* signal : {"INT", "TERM"}) {
    EXPECT_EQ(interrupted("sweep merge lines --out m", "m", signal), 1) << signal << read_text(folder / ".said");
    EXPECT_NE(read_text(folder / ".said").find("was interrupted and wrote nothing"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder / "m"));
    EXPECT_EQ(interrupted("plot forces.csv --out p", "p", signal), 1) << signal << read_text(folder / ".said");
    EXPECT_FALSE(fs::exists(folder / "p"));
    EXPECT_FALSE(anything_staged());
  }
}

TEST_F(WholeFiles, ARecordingHasOneRunAtATime) {
  fs::create_directories(folder / "below");
  fs::create_directory_symlink(folder, folder / "link");
  write_text(
      folder / "two.sh",
      "cd " + quoted(folder.string()) + "\nrun() { " + quoted(PLIANT_BINARY) +
          " run plate.obj --realtime --headless --frames 0 --probe tip=orbit --seconds $1 --record \"$2\" --out $3; }\n"
          "run 3 a.rec one >/dev/null 2>one.txt & pid=$!\n"
          "until ls a.rec.partial-* >/dev/null 2>&1; do kill -0 $pid || exit 99; sleep 0.02; done\n"
          "run 0.1 below/../a.rec two >/dev/null 2>two.txt && exit 98\n"
          "run 0.1 link/a.rec three >/dev/null 2>three.txt && exit 97\n"
          "wait $pid\n");
  EXPECT_EQ(WEXITSTATUS(std::system(
                ("env -u DISPLAY -u WAYLAND_DISPLAY bash " + quoted((folder / "two.sh").string())).c_str())),
            0);
  for (const char* said : {"two.txt", "three.txt"})
    EXPECT_NE(read_text(folder / said).find("is being recorded into by another run"), std::string::npos)
        << read_text(folder / said);
  EXPECT_EQ(pliant({"run", "plate.obj", "--replay", "a.rec", "--frames", "0"}).status, 0);
  EXPECT_FALSE(fs::exists(folder / "two"));
  EXPECT_FALSE(anything_staged());
}

TEST_F(WholeFiles, AScriptIsFollowedToItsEndOrItsCutIsSaid) {
  write_text(folder / "long.csv", "time_s,x,y,z\n0,0,0.01,0\n82,0,-0.001,0\n");
  const std::vector<std::string> words{
      "run", "plate.obj", "--probe", "tip=script:long.csv", "--rate", "100", "--frames", "0", "--out", "out"};
  const Said whole = pliant(words);
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(report("out")["ticks"], 8200);
  EXPECT_EQ(whole.err.find("lasts"), std::string::npos) << whole.err;
  std::vector<std::string> cut = words;
  cut.insert(cut.end(), {"--seconds", "2"});
  cut[9] = "cut";
  const Said said = pliant(cut);
  EXPECT_NE(said.err.find("the script of `tip` lasts 82 s, and the run ends at 2 s; --seconds 82 has all of it"),
            std::string::npos)
      << said.err;
  EXPECT_NE(report("cut")["notes"].dump().find("lasts 82 s"), std::string::npos);
}

TEST_F(WholeFiles, WhatConvertWritesIsWhatValidateTakes) {
  const std::map<std::string, std::string> odd = {
      {"flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"},
      {"twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n"},
      {"points.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n"},
      {"huge.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n"},
      {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"tiny.obj", "v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\nf 1 2 3\n"},
      {"nameless.obj", "o \nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"empty.obj", "\n"},
      {"normals.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 0 0 1e-20\nvn 0 0 5\nf 1//1 2//2 3//3\n"},
      {"empty.stl", "solid x\nendsolid x\n"},
      {"flat.stl",
       "solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nendloop\nendfacet\nendsolid "
       "x\n"},
      {"one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
  };
  for (const auto& [name, text] : odd) {
    write_text(folder / name, text);
    for (const char* extension : {".glb", ".gltf"}) {
      const std::string out = name + extension;
      const std::size_t before = count_files();
      const Said said = pliant({"convert", name, out});
      if (said.status == 0) {
        const Said valid = pliant({"validate", out});
        EXPECT_EQ(valid.status, 0) << name << extension << '\n' << valid.out;
      } else {
        EXPECT_NE(said.err.find("; "), std::string::npos) << said.err;
        EXPECT_EQ(count_files(), before) << name << ": something was written";
      }
    }
  }
}

}  // namespace
}  // namespace pliant::testing
