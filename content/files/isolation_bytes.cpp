#include <cstring>

#include "content/files/isolation.h"

namespace pliant {

double reading_time(std::size_t input_bytes) {
  return static_cast<double>(input_bytes) / 4e6;
}

void append_bytes(Bytes& out, const void* data, std::size_t size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  out.insert(out.end(), begin, begin + size);
}

bool Taker::take(void* data, std::size_t size) {
  if (size > bytes_.size()) return false;
  if (size > 0) std::memcpy(data, bytes_.data(), size);
  bytes_ = bytes_.subspan(size);
  return true;
}

}  // namespace pliant
