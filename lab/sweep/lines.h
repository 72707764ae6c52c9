// What a sweep keeps: sweep.json with every run of the plan, and a file for each shard with a line for each run that
// was done, failures too.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lab/sweep/run_id.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr const char* kSweepFile = "sweep.json";

// The plan with all its runs, in its order: the same bytes on every machine.
std::string sweep_json(const SweepPlan& plan, const ExpandedPlan& expanded);
// Puts it into the folder, which is made where it is missing. Another plan's takes its place, and `note` says so; a
// file of that name that no sweep wrote stays and is an error.
Status keep_sweep(const std::filesystem::path& folder, const std::string& json, std::string& note);
Result<PlanJson> read_sweep(const std::filesystem::path& folder);

// A file of lines that this process adds to. Each line is one write at the end of the file, and on the disk before the
// next. One process at a time has it, by a lock; a file system without locks is refused.
class LineFile {
 public:
  // `torn`: the file ended in the middle of a line, which stays behind on a line of its own.
  static Result<LineFile> open(const std::filesystem::path& file, bool& torn);
  LineFile(LineFile&& other) noexcept : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}
  LineFile& operator=(LineFile&&) = delete;
  ~LineFile();
  Status add(const PlanJson& line);

 private:
  LineFile() = default;
  std::filesystem::path path_;
  int file_ = -1;
};

// The lines of all shards in a folder, one for each id: what was done goes before what failed, a later attempt before
// an earlier one, and of several the one that comes first as text, whatever file it stands in.
struct Lines {
  std::map<std::string, PlanJson> runs;  // by id
  std::size_t torn = 0;                  // lines that are none
  std::vector<std::string> disagree;     // ids that were done more than once, with other figures
};
// A folder that is not there has none.
Status read_lines(const std::filesystem::path& folder, Lines& lines);

bool is_done(const PlanJson& line);
std::uint64_t attempt_of(const PlanJson& line);           // at a run that failed: the first is 1
std::vector<std::string> notes_of(const PlanJson& line);  // what the run said; of an older sweep none

}  // namespace pliant
