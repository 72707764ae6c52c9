#include "runtime/tasks.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/helped_time.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr int kSpins = 4000;  // some 20 us: a thread looks for work so long before it sleeps, as steps give it often

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

thread_local std::uint64_t t_helped = 0;

std::uint64_t thread_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(now.tv_nsec);
}

struct Tasks {
  std::size_t count = 0;
  detail::TaskCall call{};
  unsigned threads = 1;              // that may take part
  std::atomic<std::size_t> next{0};  // first task that has not begun
  std::atomic<unsigned> entered{1};  // threads that have taken part; the caller is number 0
  std::atomic<unsigned> inside{0};   // helpers that take part now
  std::exception_ptr thrown;         // guarded by the team's mutex
  std::uint64_t helped = 0;          // [ns] helpers' CPU time; guarded by the team's mutex

  void work(unsigned thread, std::mutex& mutex) {
    try {
      for (std::size_t i = next++; i < count; i = next++) call.call(call.task, i, thread);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  }
};

// The waiting threads. They are started when the first tasks need them.
class Team {
 public:
  ~Team() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
      ++changes_;
    }
    wake_.notify_all();
  }

  bool seize() { return !busy_.test_and_set(std::memory_order_acquire); }
  void release() { busy_.clear(std::memory_order_release); }

  // By the thread that has seized it.
  void run(Tasks& tasks) {
    {
      const std::lock_guard lock(mutex_);
      while (helpers_.size() + 1 < tasks.threads) helpers_.emplace_back([this] { help(); });
      now_ = &tasks;
      ++changes_;
    }
    wake_.notify_all();
    tasks.work(0, mutex_);
    {
      const std::lock_guard lock(mutex_);
      now_ = nullptr;  // closed to threads
    }
    for (int i = 0; i < kSpins && tasks.inside > 0; ++i) relax();
    std::unique_lock lock(mutex_);
    left_.wait(lock, [&] { return tasks.inside == 0; });
  }

 private:
  void help() {
    for (std::uint64_t seen = 0;;) {
      for (int i = 0; i < kSpins && changes_ == seen; ++i) relax();
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return ends_ || changes_ != seen; });
      if (ends_) return;
      seen = changes_;
      Tasks* const tasks = now_;
      if (!tasks || tasks->entered >= tasks->threads) continue;
      const unsigned thread = tasks->entered++;
      ++tasks->inside;
      lock.unlock();
      const std::uint64_t begin = thread_ns();
      tasks->work(thread, mutex_);
      lock.lock();
      tasks->helped += thread_ns() - begin;
      if (--tasks->inside == 0) left_.notify_one();
    }
  }

  std::atomic_flag busy_;
  std::atomic<std::uint64_t> changes_{0};  // of now_ and ends_
  std::mutex mutex_;                       // guards the following
  std::condition_variable wake_, left_;
  Tasks* now_ = nullptr;
  bool ends_ = false;
  std::vector<std::jthread> helpers_;
};

Team& team() {
  static Team team;
  return team;
}

}  // namespace

void detail::run_tasks(std::size_t count, TaskCall call) {
  const std::size_t threads = std::min<std::size_t>({count, thread_count(), kMostTaskThreads});
  if (threads < 2 || !team().seize()) {
    for (std::size_t i = 0; i < count; ++i) call.call(call.task, i, 0);
    return;
  }
  Tasks tasks;
  tasks.count = count, tasks.call = call, tasks.threads = static_cast<unsigned>(threads);
  team().run(tasks);
  team().release();
  t_helped += tasks.helped;
  if (tasks.thrown) std::rethrow_exception(tasks.thrown);
}

std::uint64_t helped_ns() {
  return t_helped;
}

}  // namespace pliant
