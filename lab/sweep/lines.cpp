#include "lab/sweep/lines.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "content/files/file_io.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr int kFormat = 1;
constexpr int kAttempts = 8;  // while other shards write the same

std::string dump(const PlanJson& json) {
  return json.dump(-1, ' ', true, PlanJson::error_handler_t::replace);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// True if the line is a complete line of a sweep.
bool is_line(const PlanJson& json) {
  const auto text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
  const auto object = [&](const char* key) { return json.contains(key) && json[key].is_object(); };
  return json.is_object() && text("id") && text("status") && object("axes") && object("timing") &&
         (is_done(json) ? object("figures") : text("error")) && (!json.contains("code") || text("code")) &&
         (!json.contains("attempt") || json["attempt"].is_number_unsigned());
}

// The reproducible part of a line: without timing, and without the axis values, of which several may denote the same
// run.
std::string compared(PlanJson line) {
  for (const char* key : {"timing", "axes", "attempt", "notes"}) line.erase(key);
  return dump(line);
}

// flock() that retries on signals; returns 0 or errno.
int lock(int file) {
  while (::flock(file, LOCK_EX | LOCK_NB) != 0)
    if (errno != EINTR) return errno;
  return 0;
}

}  // namespace

bool is_done(const PlanJson& line) {
  return line["status"] == "done";
}

std::uint64_t attempt_of(const PlanJson& line) {
  return line.contains("attempt") ? line["attempt"].get<std::uint64_t>() : 1;
}

std::vector<Note> notes_of(const PlanJson& line) {
  std::vector<Note> notes;
  if (!line.contains("notes") || !line["notes"].is_array()) return notes;
  for (const PlanJson& json : line["notes"]) {
    if (!json.is_object()) continue;
    const auto text = [&](const char* key) {
      return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : std::string();
    };
    notes.push_back({text("what"), text("cure"), text("code"), text("of")});
  }
  return notes;
}

std::string sweep_json(const SweepPlan& plan, const ExpandedPlan& expanded) {
  PlanJson json;
  json["sweep"] = kFormat;
  json["pliant"] = PLIANT_VERSION;
  json["level"] = expanded.level_name;
  json["level_hash"] = expanded.level_hash;
  json["axes"] = PlanJson::array();
  for (const SweepAxis& axis : plan.axes) {
    PlanJson one{{"name", axis.name}, {"sampled", axis.sampled}};
    if (!axis.sampled) one["values"] = axis.values;
    json["axes"].push_back(std::move(one));
  }
  // One line per run, readable and searchable even in a large plan.
  std::string text = dump(json);
  text.pop_back();
  text += ",\n\"runs\":[";
  for (std::size_t i = 0; i < expanded.runs.size(); ++i) {
    const SweepRun& run = expanded.runs[i];
    text += (i ? ",\n" : "\n") + dump(PlanJson{{"id", run.id}, {"values", run.values}});
  }
  return text + "\n]}\n";
}

Status keep_sweep(const fs::path& folder, const std::string& json, std::string& note) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{folder.string(), "cannot be created: " + error.message(), "choose another with --out"};
  const fs::path file = folder / kSweepFile;
  for (int attempt = 0;; ++attempt) {
    if (!fs::exists(fs::symlink_status(file, error))) {
      const Status written = write_file(file, bytes_of(json), Existing::kRefuse);
      if (written) return Done{};
      if (attempt == kAttempts || !fs::exists(file, error)) return written;
      continue;  // another shard was faster
    }
    const auto there = read_file(file);
    if (there && std::string(there->begin(), there->end()) == json) return Done{};
    if (const auto other = read_sweep(folder); !other) return other.error();
    note = file.string() + " was of another plan, level or version; lines of runs that both have are kept";
    return write_file(file, bytes_of(json));
  }
}

Result<PlanJson> read_sweep(const fs::path& folder) {
  const fs::path file = folder / kSweepFile;
  std::error_code no;
  if (!fs::exists(file, no))
    return Error{folder.string(), std::string("has no ") + kSweepFile, "name the --out folder of a `pliant sweep`"};
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  PlanJson json = PlanJson::parse(bytes->begin(), bytes->end(), nullptr, false);
  const auto list = [&](const char* key) { return json.contains(key) && json[key].is_array(); };
  bool sound = json.is_object() && json.contains("sweep") && json["sweep"] == kFormat && list("axes") && list("runs");
  for (const char* key : {"pliant", "level", "level_hash"})
    sound = sound && json.contains(key) && json[key].is_string();
  if (sound)
    for (const PlanJson& axis : json["axes"])
      sound = sound && axis.is_object() && axis.contains("name") && axis["name"].is_string() &&
              axis.contains("sampled") && axis["sampled"].is_boolean();
  if (sound)
    for (const PlanJson& run : json["runs"])
      sound = sound && run.is_object() && run.contains("id") && run["id"].is_string() && run.contains("values") &&
              run["values"].is_array() && run["values"].size() == json["axes"].size();
  if (!sound) return Error{file.string(), "was not written by a sweep", "move it away, or choose another --out"};
  return json;
}

Result<LineFile> LineFile::open(const fs::path& file, bool& torn) {
  LineFile out;
  out.path_ = file;
  out.file_ = ::open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (out.file_ < 0) return not_written(file.string(), "cannot be written", errno);
  const int locked = lock(out.file_);
  if (locked == EWOULDBLOCK)
    return Error{file.string(), "another sweep adds to it", "wait for it, or give each process its own --shard I/N"};
  if (locked != 0)
    return Error{file.string(), std::string("cannot be locked: ") + std::strerror(locked),
                 "choose an --out on a file system with locks, such as a local disk (`pliant sweep merge` takes "
                 "several folders)"};
  const off_t size = ::lseek(out.file_, 0, SEEK_END);
  char last = '\n';
  torn = size > 0 && ::pread(out.file_, &last, 1, size - 1) == 1 && last != '\n';
  if (torn && ::write(out.file_, "\n", 1) != 1) return not_written(file.string(), "cannot be written", errno);
  return out;
}

LineFile::~LineFile() {
  if (file_ >= 0) ::close(file_);
}

Status LineFile::add(const PlanJson& line) {
  const std::string text = dump(line) + "\n";
  const off_t before = ::lseek(file_, 0, SEEK_END);
  const ssize_t written = ::write(file_, text.data(), text.size());
  if (written == static_cast<ssize_t>(text.size()) && ::fsync(file_) == 0) return Done{};
  Error error = not_written(path_.string(), "cannot be written", written < 0 ? errno : ENOSPC);
  if (::ftruncate(file_, before) != 0) error.what += " (its last line is not whole, and is left out)";
  return error;
}

Status read_lines(const fs::path& folder, Lines& lines) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code no;
    if (name.starts_with("runs-") && name.ends_with(".jsonl") && entry->is_regular_file(no))
      files.push_back(entry->path());
  }
  if (error && error != std::errc::no_such_file_or_directory)
    return Error{folder.string(), "cannot be looked into: " + error.message(), "check its permissions"};
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream in(file);
    if (!in) return Error{file.string(), "cannot be read", "check its permissions"};
    for (std::string text; std::getline(in, text);) {
      PlanJson json = PlanJson::parse(text, nullptr, false);
      if (json.is_discarded() || !is_line(json)) {
        lines.torn += text.empty() ? 0 : 1;
        continue;
      }
      const auto id = json["id"].get<std::string>();
      const auto [at, first] = lines.runs.try_emplace(id, json);
      if (first) continue;
      const std::string ours = compared(json), theirs = compared(at->second);
      if (is_done(json) && is_done(at->second) && ours != theirs) lines.disagree.push_back(id);
      const bool better = is_done(json) != is_done(at->second)         ? is_done(json)
                          : attempt_of(json) != attempt_of(at->second) ? attempt_of(json) > attempt_of(at->second)
                          : ours != theirs
                              ? ours < theirs
                              : json.value("notes", PlanJson()).dump() < at->second.value("notes", PlanJson()).dump();
      if (better) at->second = std::move(json);
    }
    if (in.bad()) return Error{file.string(), "cannot be read to its end", "check the disk, or the connection to it"};
  }
  std::sort(lines.disagree.begin(), lines.disagree.end());
  lines.disagree.erase(std::unique(lines.disagree.begin(), lines.disagree.end()), lines.disagree.end());
  return Done{};
}

}  // namespace pliant
