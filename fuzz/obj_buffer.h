// Assimp's OBJ reader allocates and clears a 16 MiB buffer per file, whatever its size: 5 ms of page faults. Here that
// block is a range of addresses mapped to the same few pages, so that clearing it stays in the cache. Only the part as
// long as the file is read, so files up to kObjPages behave the same. Included by one target.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <new>

#include "runtime/assert.h"

namespace pliant {

constexpr std::size_t kObjBuffer = std::size_t{4096} * 4096;  // [B] size that Assimp allocates
constexpr std::size_t kObjPages = std::size_t{1} << 18;       // [B]

// The range, followed by an inaccessible page.
inline void* make_obj_buffer() {
  const int file = memfd_create("obj", 0);
  ASSERT(file >= 0 && ftruncate(file, kObjPages) == 0);
  void* const range = mmap(nullptr, kObjBuffer + kObjPages, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT(range != MAP_FAILED);
  for (std::size_t at = 0; at < kObjBuffer; at += kObjPages) {
    void* const here = static_cast<char*>(range) + at;
    ASSERT(mmap(here, kObjPages, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file, 0) == here);
  }
  close(file);
  return range;
}

// The next block of that size is the range, if the file is small enough for it.
inline void* obj_buffer = nullptr;
inline bool obj_buffer_free = false;
inline void offer_obj_buffer(std::size_t file_size) {
  if (!obj_buffer) obj_buffer = make_obj_buffer();
  obj_buffer_free = file_size <= kObjPages;
}

}  // namespace pliant

// Uses the array forms, so that the address sanitizer still tracks every block.
void* operator new(std::size_t size) {
  if (size != pliant::kObjBuffer || !pliant::obj_buffer_free) return ::operator new[](size);
  pliant::obj_buffer_free = false;
  return pliant::obj_buffer;
}
void* operator new(std::size_t size, const std::nothrow_t& tag) noexcept {
  return ::operator new[](size, tag);
}
void operator delete(void* block) noexcept {
  if (block == nullptr || block != pliant::obj_buffer) return ::operator delete[](block);
  pliant::obj_buffer_free = true;
}
void operator delete(void* block, std::size_t) noexcept {
  ::operator delete(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  ::operator delete(block);
}
