#define OPENSSL_API_COMPAT 0x10100000L  // enables SHA-256 functions that do not allocate
#include "devices/drivers/network_key.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "devices/spec.h"

namespace pliant {
namespace {

static_assert(sizeof(SHA256_CTX) == 112);
constexpr std::size_t kHashBlock = SHA256_CBLOCK;

void begin_block(std::span<const std::uint8_t> key, std::uint8_t pad, std::array<std::uint8_t, 112>& state) {
  std::array<std::uint8_t, kHashBlock> block{};
  std::copy(key.begin(), key.end(), block.begin());
  for (std::uint8_t& byte : block) byte ^= pad;
  SHA256_CTX hash;
  SHA256_Init(&hash);
  SHA256_Update(&hash, block.data(), block.size());
  std::memcpy(state.data(), &hash, sizeof hash);
  OPENSSL_cleanse(block.data(), block.size());
}

void finish_hash(const std::array<std::uint8_t, 112>& state, std::span<const std::uint8_t> bytes, std::uint8_t* out) {
  SHA256_CTX hash;
  std::memcpy(&hash, state.data(), sizeof hash);
  SHA256_Update(&hash, bytes.data(), bytes.size());
  SHA256_Final(out, &hash);
}

Result<FrameKey> checked_key(const std::string& where, std::string secret) {
  while (!secret.empty() && (secret.back() == '\n' || secret.back() == '\r')) secret.pop_back();
  if (secret.size() < FrameKey::kShortest || secret.size() > FrameKey::kLongest)
    return Error{where, "holds a key of " + std::to_string(secret.size()) + " bytes, and a key has 16 to 4096",
                 "make one with `openssl rand -hex 32`"};
  FrameKey key({reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size()});
  OPENSSL_cleanse(secret.data(), secret.size());
  return key;
}

}  // namespace

FrameKey::FrameKey(std::span<const std::uint8_t> secret) {
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> shortened{};
  if (secret.size() > kHashBlock) {
    SHA256(secret.data(), secret.size(), shortened.data());
    secret = shortened;
  }
  begin_block(secret, 0x36, inner_);
  begin_block(secret, 0x5c, outer_);
}

Result<FrameKey> FrameKey::from_file(const std::string& path) {
  const std::string where = "key file `" + path + "`";
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return Error{where, std::string("cannot be read (") + std::strerror(errno) + ")", "give another FILE"};
  struct stat about {};
  const bool regular = ::fstat(file, &about) == 0 && S_ISREG(about.st_mode);
  std::string secret(kLongest + 2, '\0');
  const ssize_t got = regular ? ::read(file, secret.data(), secret.size()) : -1;
  ::close(file);
  if (!regular) return Error{where, "is no file", "give one that holds the key alone"};
  if ((about.st_mode & (S_IRWXO | S_IWGRP)) != 0)
    return Error{where, "may be read or written by others, so that it keeps no secret", "run `chmod 600` on it"};
  secret.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return checked_key(where, std::move(secret));
}

Result<FrameKey> FrameKey::from_environment(const std::string& name) {
  const std::string where = "variable `" + name + "`";
  const char* const value = std::getenv(name.c_str());
  if (!value)
    return Error{where, "is not set, and is to hold the key of the network device", "export it, or use key=FILE"};
  return checked_key(where, value);
}

void FrameKey::tag(std::span<const std::uint8_t> bytes, std::span<std::uint8_t, kTag> out) const {
  std::array<std::uint8_t, kTag> inner;
  finish_hash(inner_, bytes, inner.data());
  finish_hash(outer_, inner, out.data());
}

bool FrameKey::fits(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t, kTag> its) const {
  std::array<std::uint8_t, kTag> right;
  tag(bytes, right);
  return CRYPTO_memcmp(right.data(), its.data(), kTag) == 0;  // constant-time comparison
}

Result<KeyedAddress> parse_keyed_address(const std::string& id) {
  KeyedAddress out;
  const std::size_t comma = id.find(',');
  out.address = std::string(trimmed(std::string_view(id).substr(0, comma)));
  if (comma == std::string::npos) return out;
  const Option option = option_of(std::string_view(id).substr(comma + 1));
  const bool file = option.key == "key", environment = option.key == "key-env";
  if ((!file && !environment) || option.value.empty())
    return Error{"network:" + out.address, "behind the address may stand ,key=FILE or ,key-env=NAME",
                 "a key itself is never given there"};
  auto key = file ? FrameKey::from_file(option.value) : FrameKey::from_environment(option.value);
  if (!key) return key.error();
  out.key = std::move(*key);
  return out;
}

}  // namespace pliant
