// A thread that runs one call at a time for its waiting callers: a GL context belongs to one thread.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>

namespace pliant_python {

class Worker {
 public:
  Worker() : thread_([this] { serve(); }) {}
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  template <class Call>
  auto run(Call&& call) {
    using T = std::invoke_result_t<Call>;
    std::exception_ptr thrown;
    if constexpr (std::is_void_v<T>) {
      give([&] {
        try {
          call();
        } catch (...) {
          thrown = std::current_exception();
        }
      });
      if (thrown) std::rethrow_exception(thrown);
    } else {
      std::optional<T> result;
      give([&] {
        try {
          result.emplace(call());
        } catch (...) {
          thrown = std::current_exception();
        }
      });
      if (thrown) std::rethrow_exception(thrown);
      return std::move(*result);
    }
  }

 private:
  void give(const std::function<void()>& call) {
    const std::lock_guard one_caller(callers_);
    std::unique_lock lock(mutex_);
    call_ = &call;
    changed_.notify_all();
    changed_.wait(lock, [&] { return call_ == nullptr; });
  }
  void serve() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return call_ || ends_; });
      if (!call_) return;
      (*call_)();
      call_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex callers_, mutex_;
  std::condition_variable changed_;
  const std::function<void()>* call_ = nullptr;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace pliant_python
