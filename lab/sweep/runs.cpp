#include "lab/sweep/runs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "content/files/file_io.h"
#include "lab/console/exit.h"
#include "lab/console/progress.h"
#include "lab/sweep/child.h"
#include "lab/sweep/figures.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr auto kLook = std::chrono::milliseconds(2);  // polling interval; a run takes at least 20 ms

// Working folder of the runs, removed at the end. Its owner holds the lock of the shard's file, so an existing folder
// of that name was left by a killed sweep.
class WorkFolder {
 public:
  static Result<WorkFolder> create(const fs::path& folder, const Shard& shard) {
    const std::string begin = fmt::format(".work-{}-of-{}-", shard.number, shard.count);
    std::vector<fs::path> left;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
      if (entry.path().filename().string().starts_with(begin) && entry.is_directory(error))
        left.push_back(entry.path());
    for (const fs::path& each : left) fs::remove_all(each, error);
    WorkFolder work;
    work.path_ = fs::absolute(folder) / (begin + std::to_string(::getpid()));
    error.clear();
    if (!fs::create_directory(work.path_, error))
      return Error{folder.string(), "cannot be written to: " + error.message(), "choose another with --out"};
    return work;
  }
  WorkFolder(WorkFolder&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  WorkFolder() = default;
  fs::path path_;
};

// A running run.
struct Slot {
  std::size_t run;
  Child child;
};

// Removes the plan's location from sentences, so that they are the same everywhere.
PlanJson without_folder(PlanJson notes, const fs::path& folder) {
  const std::string begin = folder.string() + "/";
  for (PlanJson& note : notes)
    for (PlanJson& part : note) {
      if (!part.is_string()) continue;
      auto text = part.get<std::string>();
      for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) text.erase(at, begin.size());
      part = std::move(text);
    }
  return notes;
}

Status keep_curve(const fs::path& run, const fs::path& curve) {
  std::error_code error;
  fs::create_directory(curve.parent_path(), error);
  if (!error) fs::rename(run / "forces.csv", curve, error);
  if (error) return not_written(curve.string(), "cannot be put in place", error.value());
  return Done{};
}

// True if the folder's disk has no room for a run's results.
bool is_full(const fs::path& folder) {
  constexpr std::uintmax_t kRoom = 256 << 10;  // [byte]
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  return !error && space.available < kRoom;
}

PlanJson line_of(const SweepPlan& plan, const SweepRun& run, const Child& child, const Lines& before,
                 const fs::path& folder) {
  PlanJson line{{"id", run.id}, {"status", "done"}, {"axes", PlanJson::object()}};
  for (std::size_t i = 0; i < plan.axes.size(); ++i) line["axes"][plan.axes[i].name] = run.values[i];
  PlanJson timing = PlanJson::object();
  std::optional<Error> error;
  if (child.succeeded()) {
    auto result = read_run(child.folder() / "out");
    if (result) {
      line["figures"] = std::move(result->figures);
      line["notes"] = without_folder(std::move(result->notes), run_folder(plan));
      timing = std::move(result->timing);
      if (plan.keep_curves)
        if (const Status kept = keep_curve(child.folder() / "out", curve_of(folder, run.id)); !kept)
          error = kept.error();
    } else {
      error = result.error();
    }
  } else {
    error = Error{"", child.complaint(), "", child.exit_status() == kNoRoom ? kDiskFull : ""};
  }
  if (error) {
    line.erase("figures");
    line.erase("notes");
    line["status"] = child.timed_out() ? "timed out" : "failed";
    line["exit"] = child.exit_status() ? PlanJson(*child.exit_status()) : PlanJson();
    line["error"] = error->message();
    if (!error->code.empty()) line["code"] = error->code;
    if (const auto earlier = before.runs.find(run.id); earlier != before.runs.end())
      line["attempt"] = attempt_of(earlier->second) + 1;
  }
  timing["wall_s"] = child.seconds();
  line["timing"] = std::move(timing);
  return line;
}

}  // namespace

std::vector<std::string> command_of(const SweepPlan& plan, const SweepRun& run, const std::string& out, unsigned jobs) {
  std::vector<std::string> words{
      "run", fs::absolute(plan.level).lexically_normal().string(), "--lockstep", "--headless", "--frames", "0", "--out",
      out};
  const auto is_threads = [](const std::string& argument) { return argument.starts_with("--threads="); };
  if (jobs > 1 && std::none_of(run.arguments.begin(), run.arguments.end(), is_threads)) words.push_back("--threads=1");
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  return words;
}

fs::path curve_of(const fs::path& folder, const std::string& id) {
  return folder / "curves" / (id + ".csv");
}

fs::path run_folder(const SweepPlan& plan) {
  return fs::absolute(plan.file).lexically_normal().parent_path();
}

Result<RunsDone> do_runs(const SweepPlan& plan, const ExpandedPlan& expanded, const std::vector<std::size_t>& wanted,
                         const Lines& before, LineFile& lines, const fs::path& folder, const Shard& shard,
                         unsigned jobs, const Interrupt& interrupt) {
  RunsDone done;
  auto work = WorkFolder::create(folder, shard);
  if (!work) return work.error();
  interrupt.remove_if_forced(work->path());
  const fs::path bodies = work->path() / "bodies";
  std::error_code error;
  fs::create_directory(bodies, error);
  if (error) return Error{folder.string(), "cannot be written to: " + error.message()};
  Progress progress(fmt::format("{} runs", wanted.size()));
  std::vector<Slot> slots;
  std::size_t next = 0;
  while (!interrupt.requested() && (next < wanted.size() || !slots.empty())) {
    while (next < wanted.size() && slots.size() < jobs) {
      const std::size_t run = wanted[next];
      const fs::path place = work->path() / std::to_string(run);
      fs::create_directory(place, error);
      if (error) return Error{folder.string(), "cannot be written to: " + error.message()};
      std::vector<std::string> command = command_of(plan, expanded.runs[run], (place / "out").string(), jobs);
      command.push_back("--soft-store=" + bodies.string());
      auto child = Child::start(command, run_folder(plan), place, plan.timeout);
      if (!child) return child.error();
      slots.push_back({run, std::move(child).value()});
      ++next;
    }
    bool any = false;
    for (std::size_t i = 0; i < slots.size();) {
      if (!slots[i].child.is_over()) {
        ++i;
        continue;
      }
      any = true;
      const SweepRun& run = expanded.runs[slots[i].run];
      const PlanJson line = line_of(plan, run, slots[i].child, before, folder);
      // A full disk is not a failure of the run: it is repeated when there is room.
      if (!is_done(line) && !interrupt.requested())
        if (line.value("code", std::string()) == kDiskFull || is_full(folder))
          return Error{folder.string(),
                       "run " + run.id + " could not write its results (" + line["error"].get<std::string>() + ")",
                       "with more room the same command goes on with it"};
      // A batch system may signal the sweep and its runs together: a run ended by that signal is repeated.
      if (is_done(line) || !interrupt.requested()) {
        if (Status ok = lines.add(line); !ok) return ok.error();
        ++(is_done(line) ? done.done : done.failed);
      }
      std::error_code ignored;
      fs::remove_all(slots[i].child.folder(), ignored);
      slots.erase(slots.begin() + static_cast<std::ptrdiff_t>(i));
    }
    progress.update(static_cast<double>(done.done + done.failed) / static_cast<double>(wanted.size()));
    if (!any) std::this_thread::sleep_for(kLook);
  }
  return done;
}

}  // namespace pliant
