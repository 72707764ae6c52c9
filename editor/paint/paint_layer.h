// The paint of one primitive: a persistent, immutable array of floats. `with` makes a new one that shares all unchanged
// chunks, so an undo step costs only what the stroke touched. Copies are cheap and may be read on any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pliant {

struct IndexedValue {
  std::uint32_t index;
  float value;
};

class PaintLayer {
 public:
  static constexpr std::size_t kChunk = 4096;  // values

  PaintLayer() = default;
  static PaintLayer from(std::span<const float> values);
  static PaintLayer constant(std::size_t count, float value);  // all chunks are one

  std::size_t size() const { return size_; }
  std::size_t chunk_count() const { return chunks_.size(); }
  // kChunk values; two chunks at the same address are the same.
  const float* chunk(std::size_t i) const { return chunks_[i]->data(); }
  float value(std::size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }
  // Applied in order: of several values for one index the last counts. A chunk whose bits do not change stays shared.
  PaintLayer with(std::span<const IndexedValue> changes) const;
  std::vector<float> flatten() const;

  // Bitwise: NaN equals itself, 0 differs from -0. Shared chunks are not compared.
  friend bool operator==(const PaintLayer& a, const PaintLayer& b);

  // [bytes] of the chunks that are not shared with `other`.
  std::size_t bytes_not_shared_with(const PaintLayer& other) const;

 private:
  using Chunk = std::array<float, kChunk>;  // values behind the last are 0
  std::size_t size_ = 0;
  std::vector<std::shared_ptr<const Chunk>> chunks_;
};

}  // namespace pliant
