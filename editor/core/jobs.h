// Background jobs on separate threads. Results are delivered on the interface's thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace pliant {

class Editor;

class Jobs {
 public:
  // Set when the result is no longer needed; equivalent to a std::stop_token of `source`.
  struct Stop : std::atomic<bool> {
    using std::atomic<bool>::atomic;
    std::stop_source source;
  };
  // Called on a thread; must end soon after `stop` is set. The returned function runs on the interface's thread unless
  // the job was cancelled; it may be empty.
  using Work = std::function<std::function<void(Editor&)>(const Stop& stop)>;

  ~Jobs();  // cancels all and waits
  // `key`: cancels a running job with the same key. `what` is shown while it runs; empty: not shown, and idle() ignores
  // it.
  void start(const std::string& key, const std::string& what, Work work);
  void cancel(const std::string& key);
  bool running(const std::string& key) const;
  bool any(const std::string& key) const;  // the same, including cancelled jobs that have not ended
  bool idle() const;                       // no job that the user would wait for
  bool none() const { return jobs_.empty(); }
  std::vector<std::string> under_way() const;  // what each does, for the status line
  struct Progress {
    std::string what, doing;
    double share = 0.0;    // [1] of the whole, as far as it is known
    double seconds = 0.0;  // [s] since it began
  };
  std::optional<Progress> progress(const std::string& key) const;  // of the one that runs
  // On the interface's thread, once a frame.
  void deliver(Editor& editor);
  std::function<void()> wake;  // called on a job's thread when it ends

 private:
  struct Job {
    std::string key, what;
    Stop stop{false};
    void cancel() {
      stop.store(true);
      stop.source.request_stop();
    }
    std::atomic<bool> done{false};
    std::uint64_t began = 0;   // [ns]
    mutable std::mutex mutex;  // of the two below
    std::string doing;
    double share = 0.0;
    std::function<void(Editor&)> result;
    std::thread thread;
  };
  std::vector<std::unique_ptr<Job>> jobs_;
};

}  // namespace pliant
