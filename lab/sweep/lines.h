// Files of a sweep: sweep.json with every run of the plan, and a file per shard with one line for each run that ended,
// failures included.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lab/sweep/run_id.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr const char* kSweepFile = "sweep.json";

// The plan with all its runs, in order: identical bytes on every machine.
std::string sweep_json(const SweepPlan& plan, const ExpandedPlan& expanded);
// Writes it into the folder, which is created if missing. Another plan's file is replaced, and `note` says so. A file
// of that name that no sweep wrote is kept and causes an error.
Status keep_sweep(const std::filesystem::path& folder, const std::string& json, std::string& note);
Result<PlanJson> read_sweep(const std::filesystem::path& folder);

// A file of lines that this process appends to. Each line is one write at the end of the file, and is on disk before
// the next. A lock gives one process exclusive access; a file system without locks is rejected.
class LineFile {
 public:
  // `torn`: the file ended within a line; the fragment is kept on a separate line.
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

// The lines of all shards in a folder, one per id. A completed run takes precedence over a failed one, a later attempt
// over an earlier one; among equals the line that is first in text order, independent of its file.
struct Lines {
  std::map<std::string, PlanJson> runs;  // by id
  std::size_t torn = 0;                  // malformed lines
  std::vector<std::string> disagree;     // ids completed more than once, with different figures
};
// A missing folder has no lines.
Status read_lines(const std::filesystem::path& folder, Lines& lines);

bool is_done(const PlanJson& line);
std::uint64_t attempt_of(const PlanJson& line);    // attempt number at a failed run, from 1
std::vector<Note> notes_of(const PlanJson& line);  // notes of the run

}  // namespace pliant
