// The registry: entities, and one sparse-set pool per component type.
//
// A pool keeps its components dense (iteration touches nothing else) and finds an entity's row through a sparse index.
// Views walk the smallest pool they name; `const T` in a view means "only reads". Creating, destroying, adding and
// removing may allocate and move rows, so they happen only between ticks, never inside a system or while a view is
// being walked.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "runtime/assert.h"
#include "runtime/entity.h"

namespace pliant {

// Operations on a pool that do not depend on its component type.
class PoolBase {
 public:
  virtual ~PoolBase() = default;
  virtual void remove(Entity entity) = 0;

  bool contains(Entity entity) const {
    return entity.index < sparse_.size() && sparse_[entity.index] != kAbsent &&
           entities_[sparse_[entity.index]] == entity;
  }
  std::size_t size() const { return entities_.size(); }
  Entity entity_at(std::size_t row) const { return entities_[row]; }

 protected:
  static constexpr std::uint32_t kAbsent = 0xffffffffu;
  std::vector<std::uint32_t> sparse_;  // entity index -> row, or kAbsent
  std::vector<Entity> entities_;       // row -> entity
};

// The components of one type, dense, in unspecified order.
template <class T>
class Pool final : public PoolBase {
 public:
  T& add(Entity entity, T component) {
    ASSERT(!contains(entity));
    if (entity.index >= sparse_.size()) sparse_.resize(entity.index + 1, kAbsent);
    sparse_[entity.index] = static_cast<std::uint32_t>(entities_.size());
    entities_.push_back(entity);
    components_.push_back(std::move(component));
    return components_.back();
  }

  // The last row fills the gap, so the pool stays dense.
  void remove(Entity entity) override {
    if (!contains(entity)) return;
    const std::uint32_t row = sparse_[entity.index];
    const std::uint32_t last = static_cast<std::uint32_t>(entities_.size() - 1);
    if (row != last) {
      components_[row] = std::move(components_[last]);
      entities_[row] = entities_[last];
      sparse_[entities_[row].index] = row;
    }
    components_.pop_back();
    entities_.pop_back();
    sparse_[entity.index] = kAbsent;
  }

  T& get(Entity entity) {
    ASSERT(contains(entity));
    return components_[sparse_[entity.index]];
  }
  T* find(Entity entity) { return contains(entity) ? &components_[sparse_[entity.index]] : nullptr; }

 private:
  std::vector<T> components_;  // row -> component
};

// Entities that have every one of Ts. `for (auto [entity, a, b] : registry.view<const A, B>())`.
template <class... Ts>
class View {
 public:
  explicit View(Pool<std::remove_const_t<Ts>>*... pools) : pools_(pools...) {
    // A type that was never added has no pool: the view is empty.
    const bool all = ((pools != nullptr) && ...);
    if (all) ((smallest_ = (!smallest_ || pools->size() < smallest_->size()) ? pools : smallest_), ...);
  }

  class Iterator {
   public:
    Iterator(const View& view, std::size_t row) : view_(view), row_(row) { skip_absent(); }
    std::tuple<Entity, Ts&...> operator*() const {
      const Entity entity = view_.smallest_->entity_at(row_);
      return {entity, std::get<Pool<std::remove_const_t<Ts>>*>(view_.pools_)->get(entity)...};
    }
    Iterator& operator++() {
      ++row_;
      skip_absent();
      return *this;
    }
    bool operator!=(const Iterator& other) const { return row_ != other.row_; }

   private:
    void skip_absent() {
      while (row_ < view_.rows() && !view_.has_all(view_.smallest_->entity_at(row_))) ++row_;
    }
    const View& view_;
    std::size_t row_;
  };

  Iterator begin() const { return Iterator(*this, 0); }
  Iterator end() const { return Iterator(*this, rows()); }

 private:
  std::size_t rows() const { return smallest_ ? smallest_->size() : 0; }
  bool has_all(Entity entity) const {
    return (std::get<Pool<std::remove_const_t<Ts>>*>(pools_)->contains(entity) && ...);
  }

  std::tuple<Pool<std::remove_const_t<Ts>>*...> pools_;
  const PoolBase* smallest_ = nullptr;
};

class Registry {
 public:
  Entity create() {
    if (!free_.empty()) {
      const std::uint32_t index = free_.back();
      free_.pop_back();
      alive_[index] = true;
      return {index, versions_[index]};
    }
    versions_.push_back(0);
    alive_.push_back(true);
    return {static_cast<std::uint32_t>(versions_.size() - 1), 0};
  }

  void destroy(Entity entity) {
    ASSERT(alive(entity));
    for (auto& pool : pools_)
      if (pool) pool->remove(entity);
    ++versions_[entity.index];
    alive_[entity.index] = false;
    free_.push_back(entity.index);
  }

  bool alive(Entity entity) const {
    return entity.index < versions_.size() && alive_[entity.index] && versions_[entity.index] == entity.version;
  }
  std::size_t size() const { return versions_.size() - free_.size(); }

  template <class T>
  T& add(Entity entity, T component = {}) {
    ASSERT(alive(entity));
    return pool_or_new<T>().add(entity, std::move(component));
  }
  template <class T>
  void remove(Entity entity) {
    if (Pool<T>* p = pool<T>()) p->remove(entity);
  }
  template <class T>
  bool has(Entity entity) const {
    const Pool<T>* p = pool<T>();
    return p && p->contains(entity);
  }
  template <class T>
  T& get(Entity entity) {
    ASSERT(pool<T>());
    return pool<T>()->get(entity);
  }
  template <class T>
  const T& get(Entity entity) const {
    return const_cast<Registry*>(this)->get<T>(entity);
  }
  template <class T>
  T* find(Entity entity) {
    Pool<T>* p = pool<T>();
    return p ? p->find(entity) : nullptr;
  }
  template <class T>
  const T* find(Entity entity) const {
    return const_cast<Registry*>(this)->find<T>(entity);
  }
  template <class... Ts>
  View<Ts...> view() {
    return View<Ts...>(pool<std::remove_const_t<Ts>>()...);
  }
  template <class... Ts>
  View<const Ts...> view() const {
    return View<const Ts...>(const_cast<Registry*>(this)->pool<std::remove_const_t<Ts>>()...);
  }

 private:
  // Component types are numbered in the order of first use.
  static std::size_t next_type() {
    static std::atomic<std::size_t> count{0};
    return count++;
  }
  template <class T>
  static std::size_t type_of() {
    static const std::size_t type = next_type();
    return type;
  }
  template <class T>
  Pool<T>* pool() {
    const std::size_t type = type_of<T>();
    return type < pools_.size() ? static_cast<Pool<T>*>(pools_[type].get()) : nullptr;
  }
  template <class T>
  const Pool<T>* pool() const {
    return const_cast<Registry*>(this)->pool<T>();
  }
  template <class T>
  Pool<T>& pool_or_new() {
    const std::size_t type = type_of<T>();
    if (type >= pools_.size()) pools_.resize(type + 1);
    if (!pools_[type]) pools_[type] = std::make_unique<Pool<T>>();
    return static_cast<Pool<T>&>(*pools_[type]);
  }

  std::vector<std::uint32_t> versions_;
  std::vector<bool> alive_;
  std::vector<std::uint32_t> free_;
  std::vector<std::unique_ptr<PoolBase>> pools_;
};

}  // namespace pliant
