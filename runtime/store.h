// A typed store for data too large for a component (meshes, height fields, textures); the component holds the handle.
// Addresses stay valid for the life of the store, so a system may keep a reference during a tick.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "runtime/assert.h"

namespace pliant {

template <class T>
struct Handle {
  std::uint32_t index = 0xffffffffu;
  bool valid() const { return index != 0xffffffffu; }
  friend bool operator==(Handle, Handle) = default;
};

template <class T>
class Store {
 public:
  Handle<T> add(T item) {
    items_.push_back(std::move(item));
    return {static_cast<std::uint32_t>(items_.size() - 1)};
  }
  T& operator[](Handle<T> handle) {
    ASSERT(handle.index < items_.size());
    return items_[handle.index];
  }
  const T& operator[](Handle<T> handle) const {
    ASSERT(handle.index < items_.size());
    return items_[handle.index];
  }
  std::size_t size() const { return items_.size(); }

 private:
  std::deque<T> items_;
};

}  // namespace pliant
