#include "c/handles.h"

#include <array>
#include <vector>

namespace pliant::c {
namespace {

// A handle holds kind, generation and slot: in 64 bits, or in the 32 of WebAssembly.
constexpr bool kWide = sizeof(void*) == sizeof(std::uint64_t);
constexpr std::uint32_t kPerChunk = kWide ? 4096 : 64, kMostChunks = kPerChunk;
constexpr int kIndexBits = kWide ? 24 : 12, kGenerationBits = kWide ? 32 : 16;

// Chunks are allocated as needed, and read without a lock. Leaked on purpose: handles are valid until the process ends.
struct Table {
  std::array<std::atomic<Slot*>, kMostChunks> chunks{};
  std::mutex change;  // of what follows
  std::uint32_t count = 0;
  std::vector<std::uint32_t> free;
};

Table& table() {
  static Table* const all = new Table;
  return *all;
}

Slot* slot_at(std::uint32_t index) {
  Slot* const chunk = table().chunks[index / kPerChunk].load(std::memory_order_acquire);
  return chunk ? &chunk[index % kPerChunk] : nullptr;
}

std::uint64_t token_of(HandleKind kind, std::uint32_t generation, std::uint32_t index) {
  return std::uint64_t{static_cast<std::uint8_t>(kind)} << (kIndexBits + kGenerationBits) |
         std::uint64_t{generation} % (std::uint64_t{1} << kGenerationBits) << kIndexBits | index;
}

std::uint32_t index_of(std::uint64_t token) {
  return static_cast<std::uint32_t>(token & ((1u << kIndexBits) - 1));
}

}  // namespace

void* make_handle(HandleKind kind, std::unique_ptr<Handle> object) {
  Table& all = table();
  const std::lock_guard lock(all.change);
  std::uint32_t index = all.count;
  if (!all.free.empty()) {
    index = all.free.back();
    all.free.pop_back();
  } else {
    if (index == kPerChunk * kMostChunks) return nullptr;
    std::atomic<Slot*>& chunk = all.chunks[index / kPerChunk];
    if (!chunk.load()) chunk.store(new Slot[kPerChunk], std::memory_order_release);
    all.free.reserve(++all.count);  // a free slot is noted without an allocation
  }
  Slot& slot = *slot_at(index);
  {
    const std::lock_guard stopping(slot.devices);  // an emergency stop of the destroyed handle may look at it
    slot.object = std::move(object);
  }
  const std::uint64_t token = token_of(kind, ++slot.generation, index);
  slot.token.store(token, std::memory_order_release);
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(token));
}

Slot* find_slot(const void* handle, HandleKind kind) {
  const std::uint64_t token = reinterpret_cast<std::uintptr_t>(handle);
  if (token >> (kIndexBits + kGenerationBits) != static_cast<std::uint8_t>(kind)) return nullptr;
  Slot* const slot = slot_at(index_of(token));
  return slot && slot->token.load(std::memory_order_acquire) == token ? slot : nullptr;
}

Held::Held(const void* handle, HandleKind kind) {
  if (!handle) {
    failure_ = Failure::kNull;
    return;
  }
  Slot* const slot = find_slot(handle, kind);
  if (!slot) {
    failure_ = Failure::kDead;
    return;
  }
  if (slot->busy.exchange(true, std::memory_order_acquire)) {
    failure_ = Failure::kBusy;
    return;
  }
  slot_ = slot;
  if (find_slot(handle, kind) != slot) failure_ = Failure::kDead;  // another thread has destroyed it meanwhile
}

Held::~Held() {
  if (!slot_) return;
  const std::uint32_t index = index_of(slot_->token.load());
  if (destroyed_) slot_->token.store(0);
  slot_->busy.store(false, std::memory_order_release);
  if (!destroyed_) return;
  const std::lock_guard lock(table().change);
  table().free.push_back(index);
}

void Held::destroy() {
  const std::lock_guard lock(slot_->devices);
  slot_->object.reset();
  destroyed_ = true;
}

void for_each_idle(HandleKind kind, void (*act)(Handle&)) {
  const std::lock_guard lock(table().change);
  for (std::uint32_t i = 0; i < table().count; ++i) {
    const auto token = slot_at(i)->token.load();
    const Held held(reinterpret_cast<void*>(static_cast<std::uintptr_t>(token)), kind);
    if (token && held.failure() == Held::Failure::kNone) act(*held.slot().object);
  }
}

}  // namespace pliant::c
