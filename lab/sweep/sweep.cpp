#include "lab/sweep/sweep.h"

#include <cstdlib>

#include "content/files/file_io.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/sweep/runs.h"
#include "lab/sweep/sweep_notes.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

enum class State { kToDo, kDone, kFailed };

struct Work {
  std::vector<State> states;                   // per run of the plan
  std::vector<std::size_t> wanted;             // runs of this shard still to execute, in the plan's order
  std::size_t mine = 0, done = 0, failed = 0;  // of this shard's
  std::size_t without_curve = 0;               // completed, but to be repeated for their curves
};

// A run ended by a full disk has not failed.
State state_of(const PlanJson& line) {
  if (is_done(line)) return State::kDone;
  return line.value("code", std::string()) == kDiskFull ? State::kToDo : State::kFailed;
}

// `curves`: the folder of kept curves; empty: curves are not kept.
Work find_work(const ExpandedPlan& expanded, const Lines& lines, const Shard& shard, bool retry_failed,
               const fs::path& curves) {
  Work work;
  std::map<std::string, bool> chosen;  // different values may denote the same run
  for (std::size_t i = 0; i < expanded.runs.size(); ++i) {
    const auto line = lines.runs.find(expanded.runs[i].id);
    State state = line == lines.runs.end() ? State::kToDo : state_of(line->second);
    std::error_code no;
    if (state == State::kDone && !curves.empty() && !fs::exists(curve_of(curves, expanded.runs[i].id), no)) {
      state = State::kToDo;
      work.without_curve += shard.has(i);
    }
    work.states.push_back(state);
    if (!shard.has(i)) continue;
    ++work.mine;
    work.done += state == State::kDone;
    work.failed += state == State::kFailed;
    const bool wanted = state == State::kToDo || (state == State::kFailed && retry_failed);
    if (wanted && chosen.emplace(expanded.runs[i].id, true).second) work.wanted.push_back(i);
  }
  return work;
}

std::string settings_of(const SweepPlan& plan, const SweepRun& run) {
  std::string text;
  for (std::size_t i = 0; i < plan.axes.size(); ++i)
    text += (i ? " " : "") + plan.axes[i].name + "=" + text_of(run.values[i]);
  return text;
}

void print_list(const SweepPlan& plan, const ExpandedPlan& expanded, const Work& work, const Shard& shard) {
  constexpr const char* kWords[] = {"to do", "done", "failed"};
  for (std::size_t i = 0; i < expanded.runs.size(); ++i)
    if (shard.has(i))
      print("{}  {:<6}  {}\n", expanded.runs[i].id, std::string(kWords[static_cast<int>(work.states[i])]),
            settings_of(plan, expanded.runs[i]));
}

// Quoted for a shell.
std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./,:+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void print_commands(const SweepPlan& plan, const ExpandedPlan& expanded, const Work& work, unsigned jobs) {
  std::error_code no;
  const bool here = fs::equivalent(run_folder(plan), ".", no);
  const std::string begin = here ? "" : "cd " + quoted(run_folder(plan).string()) + " && ";
  const fs::path out = here ? "out" : fs::absolute("out");
  for (const std::size_t i : work.wanted) {
    std::string line = begin + "pliant";
    for (const std::string& word : command_of(plan, expanded.runs[i], (out / expanded.runs[i].id).string(), jobs))
      line += " " + quoted(word);
    print("{}\n", line);
  }
}

std::string shard_text(const Shard& shard) {
  return shard.count == 1 ? std::string()
                          : " in shard " + std::to_string(shard.number) + " of " + std::to_string(shard.count);
}

// Prints the notes of this shard's runs, including earlier ones.
void say_notes(const fs::path& folder, const Shard& shard) {
  auto table = read_table({folder});
  if (!table) return;
  std::vector<SweepRow> mine;
  bool whole = true;
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    whole = whole && table->rows[i].done() && shard.has(i);
    if (shard.has(i)) mine.push_back(std::move(table->rows[i]));
  }
  table->rows = std::move(mine);
  for (const std::string& sentence : sentences_of(find_notes(*table), *table, whole)) note(sentence);
}

int report(const fs::path& folder, const Work& work, const RunsDone& done, const Shard& shard,
           const Interrupt& interrupt) {
  const std::size_t now = done.done + done.failed, left = work.wanted.size() - now;
  print("{}: {} runs{}: {} done now, {} before, {} failed now{}{}\n", folder.string(), work.mine, shard_text(shard),
        done.done, work.mine - work.wanted.size(), done.failed,
        done.failed ? "; the lines say why, --retry-failed does them again" : "",
        left ? "" : "; `pliant sweep merge` makes tables and plots of them");
  if (!interrupt.requested()) return kDone;
  return fail(
      kFailed,
      {"sweep", std::to_string(left) + " runs are left of " + std::to_string(work.wanted.size()) + ": interrupted",
       "the same command goes on with them"});
}

}  // namespace

int sweep(const SweepOptions& options) {
  if (options.plan.empty())
    return fail(kUsage, {"sweep", "say which plan, or `merge`", "see `pliant sweep --help` and docs/sweep.md"});
  const auto shard = choose_shard(options.shard, [](const char* name) { return std::getenv(name); });
  if (!shard) return fail(kUsage, shard.error());
  const auto plan = read_plan(options.plan, options.check);
  if (!plan) return fail(kFailed, plan.error());
  const auto expanded = expand_plan(*plan);
  if (!expanded) return fail(kFailed, expanded.error());
  if (!shard->from.empty())
    note("shard " + std::to_string(shard->number) + " of " + std::to_string(shard->count) + ", by " + shard->from +
         "; --shard 1/1 does all");

  const fs::path folder = options.out.empty() ? "out" / plan->file.stem() : fs::path(options.out);
  Lines lines;
  if (options.list || options.dry_run) {
    if (const Status read = read_lines(folder, lines); !read) return fail(kFailed, read.error());
    const Work work =
        find_work(*expanded, lines, *shard, options.retry_failed, plan->keep_curves ? folder : fs::path());
    if (options.list) print_list(*plan, *expanded, work, *shard);
    if (options.dry_run) print_commands(*plan, *expanded, work, options.jobs);
    print("{}: {} runs{}: {} done, {} failed, {} would be done now\n", folder.string(), work.mine, shard_text(*shard),
          work.done, work.failed, work.wanted.size());
    return kDone;
  }
  std::string replaced;
  if (const Status kept = keep_sweep(folder, sweep_json(*plan, *expanded), replaced); !kept)
    return fail(kFailed, kept.error());
  if (!replaced.empty()) note(replaced);
  // The work is determined under the lock: the previous holder may just have added lines.
  bool torn = false;
  auto file = LineFile::open(folder / shard->file(), torn);
  if (!file) return fail(kFailed, file.error());
  if (const Status read = read_lines(folder, lines); !read) return fail(kFailed, read.error());
  const Work work = find_work(*expanded, lines, *shard, options.retry_failed, plan->keep_curves ? folder : fs::path());
  if (work.without_curve > 0)
    note(std::to_string(work.without_curve) + " runs were done without keeping their curves, and are done again");
  const Interrupt interrupt({"ending; runs under way are left out; press Ctrl-C again to quit at once",
                             "quit at once; what was done before stays"});
  const auto done = do_runs(*plan, *expanded, work.wanted, lines, *file, folder, *shard, options.jobs, interrupt);
  if (!done) return fail(kFailed, done.error());
  if (torn)
    note((folder / shard->file()).string() + " ended in the middle of a line, which is left behind; its run was to do");
  if (!interrupt.requested()) say_notes(folder, *shard);
  return report(folder, work, *done, *shard, interrupt);
}

}  // namespace pliant
