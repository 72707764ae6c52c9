// Handles of the C interface. A handle is a number (kind, generation, slot) in the form of a pointer, which is never
// dereferenced: one that was destroyed, or is of another kind, is recognised. Slots are never freed, and reused under a
// new generation.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace pliant::c {

enum class HandleKind : std::uint8_t { kScene = 1, kSession, kPictures };

struct Handle {
  virtual ~Handle() = default;
};

struct Slot {
  std::atomic<std::uint64_t> token{0};  // 0: free
  std::atomic<bool> busy{false};        // a call uses it
  std::mutex devices;  // held while devices are connected, released, restarted: Session::emergency_stop
  std::unique_ptr<Handle> object;
  std::uint32_t generation = 0;
};

// A new handle of `object`. Null: too many (16 million) are alive.
void* make_handle(HandleKind kind, std::unique_ptr<Handle> object);
// The slot of a handle of that kind that is alive; null: it is not. For a handle that is not held, only for a moment.
Slot* find_slot(const void* handle, HandleKind kind);

// Exclusive use of a handle for one call.
class Held {
 public:
  enum class Failure : std::uint8_t { kNone, kNull, kDead, kBusy };
  Held(const void* handle, HandleKind kind);
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held();
  Failure failure() const { return failure_; }
  Slot& slot() const { return *slot_; }
  // Ends the object and frees the slot, which stays held until the call ends.
  void destroy();

 private:
  Slot* slot_ = nullptr;
  Failure failure_ = Failure::kNone;
  bool destroyed_ = false;
};

// Calls `act(Handle&)` for every object of that kind that no call uses.
void for_each_idle(HandleKind kind, void (*act)(Handle&));

}  // namespace pliant::c
