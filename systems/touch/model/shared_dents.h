// Contacts of one tip in one dent, and the depths of the ridges between them.
#pragma once

#include <span>

#include "systems/touch/collide/contact_search.h"
#include "systems/touch/collide/ridge.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/pressing.h"

namespace pliant {

// Pairs of contacts of one sphere in one dent.
class SharedDents {
 public:
  // The last contact, which may be in one dent with those before.
  void add(const ContactSearch& search, std::span<const Pressing> pressing);

  // A contact that stores nothing after all.
  void remove(std::size_t contact) {
    while (count_ > 0 && pairs_.all[count_ - 1].b == contact) --count_;
  }

  std::span<SharedDent> of(std::span<const Pressing> pressing);

 private:
  static constexpr std::uint16_t kNone = 0xffff;
  static constexpr std::size_t kMostPairs = 256;
  struct Pair {
    std::uint32_t a, b;
    Ridge ridge;
  };

  std::uint16_t between(std::size_t a, std::size_t b) const { return a < b ? pair_[a][b] : pair_[b][a]; }

  static bool shared(std::span<const Pressing> pressing, const Pair& pair, const Ridge& ridge, SharedDent& dent);

  std::array<std::array<std::uint16_t, kMaxContactsPerObject>, kMaxContactsPerObject> pair_;
  Room<Pair, kMostPairs> pairs_;
  Room<SharedDent, kMostPairs> dents_;
  std::size_t count_ = 0;
};

}  // namespace pliant
