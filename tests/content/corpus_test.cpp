// Reads every file of the corpus. Sound files load; unsound ones are rejected with one sentence; none crashes, hangs or
// takes more than a gigabyte. Each file is read in a child process, so that a crash is one failed expectation and not
// the end of the run.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "content/files/exr.h"
#include "content/level_file.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = PLIANT_CORPUS_DIR;
#define SKIP_WITHOUT_CORPUS() \
  if (!fs::exists(kCorpus)) GTEST_SKIP() << "the corpus is not beside the project"

#ifdef PLIANT_SANITIZED
constexpr unsigned kSeconds = 60;
#else
constexpr unsigned kSeconds = 5;
#endif

enum class Outcome { kLoaded, kRefused, kCrashed };
struct Read {
  Outcome outcome = Outcome::kCrashed;
  std::string sentence;  // the error
};

// Calls read() in a child with limited time and memory; read() returns "" or an error sentence.
Read in_child(const std::function<std::string()>& read) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
#ifndef PLIANT_SANITIZED
    const rlimit memory{rlim_t{1} << 30, rlim_t{1} << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    alarm(kSeconds);
    const std::string sentence = read();
    const std::string answer = sentence.empty() ? "L" : "R" + sentence;
    const bool written = write(ends[1], answer.data(), answer.size()) == static_cast<ssize_t>(answer.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string answer;
  char buffer[4096];
  for (ssize_t got; (got = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    answer.append(buffer, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty()) return {};
  return {answer[0] == 'L' ? Outcome::kLoaded : Outcome::kRefused, answer.substr(1)};
}

Read read_level(const fs::path& path) {
  return in_child([&] {
    const Result<Level> level = load_level(path);
    return level ? std::string() : level.error().message();
  });
}
Read read_panorama(const fs::path& path) {
  return in_child([&] {
    const Result<Panorama> panorama = load_panorama(path);
    if (panorama)
      for (const float value : panorama->rgb)
        if (!(value >= 0.0f && value < INFINITY)) std::abort();
    return panorama ? std::string() : panorama.error().message();
  });
}

std::vector<fs::path> files_below(const char* folder, const std::set<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kCorpus / folder))
    if (entry.is_regular_file() && (extensions.empty() || extensions.count(entry.path().extension().string())))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// An error is one sentence that begins with the file.
void expect_sentence(const Read& read, const fs::path& path) {
  EXPECT_NE(read.outcome, Outcome::kCrashed) << path;
  if (read.outcome != Outcome::kRefused) return;
  EXPECT_EQ(read.sentence.rfind(path.string(), 0), 0u) << read.sentence;
  EXPECT_EQ(read.sentence.find('\n'), std::string::npos) << read.sentence;
}

// Errors in the validator's report that we accept, with the reason. An input may load only if all its errors have such
// a code.
const std::map<std::string, const char*> kAcceptedCodes = {
    {"ACCESSOR_WEIGHTS_NON_NORMALIZED",
     "skins are read once, at rest, and weights are divided by their sum; shipped models break this"},
    {"ACCESSOR_VECTOR3_NON_UNIT",
     "only where the length is exactly 0, which exporters write at degenerate triangles: made anew"},
    {"IO_ERROR", "only for a picture that is missing: a surface can be touched without it"},
};

TEST(Corpus, GltfFilesAreRefusedExactlyWhereTheKhronosValidatorReportsErrors) {
  SKIP_WITHOUT_CORPUS();
  int judged = 0;
  for (const fs::path& report_path : files_below("gltf-invalid/khronos-validator", {".json"})) {
    const std::string name = report_path.string();
    if (name.size() < 12 || name.compare(name.size() - 12, 12, ".report.json") != 0) continue;
    const fs::path input = name.substr(0, name.size() - 12);
    const nlohmann::json report = nlohmann::json::parse(std::ifstream(report_path));
    bool forgiven = true;
    for (const auto& message : report["issues"]["messages"])
      if (message["severity"] == 0) forgiven &= kAcceptedCodes.count(message["code"].get<std::string>()) != 0;
    const bool sound = report["issues"]["numErrors"] == 0;
    const Read read = read_level(input);
    expect_sentence(read, input);
    if (sound)
      EXPECT_EQ(read.outcome, Outcome::kLoaded) << input << ": " << read.sentence;
    else if (!forgiven)
      EXPECT_EQ(read.outcome, Outcome::kRefused) << input;
    ++judged;
  }
  EXPECT_GE(judged, 100);
}

TEST(Corpus, TortureFilesOfOtherParsersAreRefusedInOneSentence) {
  SKIP_WITHOUT_CORPUS();
  for (const fs::path& path : files_below("gltf-invalid", {".gltf", ".glb"})) {
    if (path.string().find("khronos-validator") != std::string::npos) continue;
    const Read read = read_level(path);
    expect_sentence(read, path);
    EXPECT_EQ(read.outcome, Outcome::kRefused) << path;
  }
}

TEST(Corpus, SoundMeshesOfEveryFormatLoad) {
  SKIP_WITHOUT_CORPUS();
  for (const fs::path& path : files_below("meshes-valid", {".glb", ".gltf", ".obj"})) {
    const Read read = read_level(path);
    EXPECT_EQ(read.outcome, Outcome::kLoaded) << path << ": " << read.sentence;
  }
}

TEST(Corpus, DracoFilesOldOnesIncludedDecodeOrAreRefusedInOneSentence) {
  SKIP_WITHOUT_CORPUS();
  int loaded = 0;
  for (const fs::path& path : files_below("meshes-draco", {".drc", ".glb", ".gltf"})) {
    const Read read = read_level(path);
    expect_sentence(read, path);
    loaded += read.outcome == Outcome::kLoaded;
    // Rejected are point clouds, and two files whose buffers are not in the corpus.
    if (read.outcome == Outcome::kRefused)
      EXPECT_TRUE(read.sentence.find("point cloud") != std::string::npos ||
                  read.sentence.find("no such file") != std::string::npos)
          << read.sentence;
  }
  EXPECT_GE(loaded, 20);
}

TEST(Corpus, DamagedMeshesOfOtherFormatsAreReadOrRefusedInOneSentence) {
  SKIP_WITHOUT_CORPUS();
  for (const fs::path& path : files_below("mesh-other-invalid", {})) {
    if (path.extension() == ".txt") continue;
    expect_sentence(read_level(path), path);
  }
}

TEST(Corpus, SoundPanoramasLoadUnlessDeepAndNothingInThemIsInfinite) {
  SKIP_WITHOUT_CORPUS();
  const std::set<std::string> refused = {
      "11.deep.exr",  // deep samples only
      "tiled.exr",    // its second tile row claims another level: the library's own test of that
  };
  for (const fs::path& path : files_below("exr-valid", {".exr"})) {
    const Read read = read_panorama(path);
    expect_sentence(read, path);
    EXPECT_EQ(read.outcome, refused.count(path.filename().string()) ? Outcome::kRefused : Outcome::kLoaded)
        << path << ": " << read.sentence;
  }
}

TEST(Corpus, DamagedPanoramasAreReadOrRefusedInOneSentence) {
  SKIP_WITHOUT_CORPUS();
  for (const fs::path& path : files_below("exr-damaged", {})) expect_sentence(read_panorama(path), path);
}

}  // namespace
}  // namespace pliant::test
