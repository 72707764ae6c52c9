#include "editor/core/jobs.h"

#include <algorithm>
#include <exception>

#include "editor/core/editor.h"
#include "runtime/clock.h"
#include "runtime/long_work.h"

namespace pliant {

Jobs::~Jobs() {
  for (const auto& job : jobs_) job->cancel();
  for (const auto& job : jobs_)
    if (job->thread.joinable()) job->thread.join();
}

void Jobs::start(const std::string& key, const std::string& what, Work work) {
  cancel(key);
  auto job = std::make_unique<Job>();
  job->key = key;
  job->what = what;
  job->began = now_ns();
  Job* const it = job.get();
  jobs_.push_back(std::move(job));
  it->thread = std::thread([this, it, work = std::move(work)] {
    const OpenProgress watch = [it](double share, const std::string& doing) {
      const std::lock_guard lock(it->mutex);
      it->share = share;
      it->doing = doing;
      return !it->stop.load();
    };
    try {
      const WatchedWork watched(watch);
      it->result = work(it->stop);
    } catch (const WorkStopped&) {
    } catch (const std::exception& error) {
      it->result = [what = it->what, why = std::string(error.what())](Editor& editor) {
        editor.say(what + " failed: " + why, Severity::kError);
      };
    }
    it->done = true;
    if (wake) wake();
  });
}

void Jobs::cancel(const std::string& key) {
  for (const auto& job : jobs_)
    if (job->key == key) job->cancel();
}

bool Jobs::running(const std::string& key) const {
  return std::any_of(jobs_.begin(), jobs_.end(), [&](const auto& job) { return job->key == key && !job->stop; });
}

bool Jobs::any(const std::string& key) const {
  return std::any_of(jobs_.begin(), jobs_.end(), [&](const auto& job) { return job->key == key; });
}

bool Jobs::idle() const {
  return std::none_of(jobs_.begin(), jobs_.end(),
                      [](const auto& job) { return !job->stop.load() && !job->what.empty(); });
}

std::vector<std::string> Jobs::under_way() const {
  std::vector<std::string> all;
  for (const auto& job : jobs_)
    if (!job->stop && !job->done && !job->what.empty()) all.push_back(job->what);
  return all;
}

std::optional<Jobs::Progress> Jobs::progress(const std::string& key) const {
  for (const auto& job : jobs_) {
    if (job->key != key || job->stop || job->done) continue;
    const std::lock_guard lock(job->mutex);
    return Progress{job->what, job->doing, job->share, 1e-9 * static_cast<double>(now_ns() - job->began)};
  }
  return {};
}

void Jobs::deliver(Editor& editor) {
  std::vector<std::unique_ptr<Job>> ended;
  for (auto& job : jobs_)
    if (job->done) ended.push_back(std::move(job));
  std::erase(jobs_, nullptr);
  for (const auto& job : ended) {
    job->thread.join();
    if (!job->stop && job->result) job->result(editor);
  }
}

}  // namespace pliant
