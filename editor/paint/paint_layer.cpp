#include "editor/paint/paint_layer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <unordered_set>

#include "runtime/assert.h"

namespace pliant {

PaintLayer PaintLayer::from(std::span<const float> values) {
  PaintLayer layer;
  layer.size_ = values.size();
  for (std::size_t begin = 0; begin < values.size(); begin += kChunk) {
    const std::span<const float> run = values.subspan(begin, std::min(kChunk, values.size() - begin));
    auto chunk = std::make_shared<Chunk>();  // zeros
    std::copy(run.begin(), run.end(), chunk->begin());
    layer.chunks_.push_back(std::move(chunk));
  }
  return layer;
}

PaintLayer PaintLayer::constant(std::size_t count, float value) {
  PaintLayer layer;
  layer.size_ = count;
  const auto filled = [&](std::size_t values) {
    auto chunk = std::make_shared<Chunk>();
    std::fill_n(chunk->begin(), values, value);
    return chunk;
  };
  if (count >= kChunk) layer.chunks_.assign(count / kChunk, filled(kChunk));
  if (count % kChunk != 0) layer.chunks_.push_back(filled(count % kChunk));
  return layer;
}

PaintLayer PaintLayer::with(std::span<const IndexedValue> changes) const {
  PaintLayer out = *this;
  std::vector<Chunk*> own(chunks_.size(), nullptr);  // chunks created here, which are not shared yet
  for (const auto [index, value] : changes) {
    ASSERT(index < size_);
    const std::size_t place = index / kChunk, at = index % kChunk;
    if (std::bit_cast<std::uint32_t>((*out.chunks_[place])[at]) == std::bit_cast<std::uint32_t>(value)) continue;
    if (own[place] == nullptr) {
      auto copy = std::make_shared<Chunk>(*chunks_[place]);
      own[place] = copy.get();
      out.chunks_[place] = std::move(copy);
    }
    (*own[place])[at] = value;
  }
  return out;
}

std::vector<float> PaintLayer::flatten() const {
  std::vector<float> values;
  values.reserve(size_);
  for (const auto& chunk : chunks_) {
    const std::size_t count = std::min(kChunk, size_ - values.size());
    values.insert(values.end(), chunk->begin(), chunk->begin() + static_cast<std::ptrdiff_t>(count));
  }
  return values;
}

bool operator==(const PaintLayer& a, const PaintLayer& b) {
  return a.size_ == b.size_ && std::equal(a.chunks_.begin(), a.chunks_.end(), b.chunks_.begin(), b.chunks_.end(),
                                          [](const auto& x, const auto& y) {
                                            return x == y || std::memcmp(x->data(), y->data(), sizeof(*x)) == 0;
                                          });
}

std::size_t PaintLayer::bytes_not_shared_with(const PaintLayer& other) const {
  std::unordered_set<const Chunk*> seen;
  for (const auto& chunk : other.chunks_) seen.insert(chunk.get());
  std::size_t bytes = 0;
  for (const auto& chunk : chunks_)
    if (seen.insert(chunk.get()).second) bytes += sizeof(Chunk);
  return bytes;
}

}  // namespace pliant
