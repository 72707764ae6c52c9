// The device side of Pliant's network protocol, to be copied into the firmware of a custom device. It needs nothing of
// Pliant: only sockets, and libcrypto for the key (without it, remove the code between #ifdef PLIANT_KEY and #endif).
// Instead of encoders and motors, it simulates a 100 g handle pulled down by a spring. docs/devices/protocols.md
// documents every byte.
//
//   network_device [PORT [KEYFILE]]    then: pliant run LEVEL --probe NAME=device:network:PORT[,key=KEYFILE]
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#ifdef PLIANT_KEY
#include <openssl/crypto.h>
#include <openssl/hmac.h>
#include <sys/stat.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

namespace {

enum Kind : std::uint8_t { kAsk = 1, kOpen, kDescription, kState, kForce, kClose, kBusy };
constexpr double kSilence = 0.020;                             // [s] watchdog: after this time without a force frame,
                                                               // zero force
constexpr double kAnswer = 0.040;                              // [s] the same without an answer to one of our states
constexpr double kForget = 1.0;                                // [s] without any frame: another engine may connect
constexpr int kLength[] = {0, 32, 32, 104, 100, 344, 32, 96};  // of each kind of frame, without a tag
constexpr int kTag = 32;                                       // bytes of a tag
constexpr float kMaxForce = 3.0f;                              // [N]

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::uint32_t crc32(const std::uint8_t* bytes, int size) {
  std::uint32_t value = ~0u;
  for (int i = 0; i < size; ++i) {
    value ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ (value & 1 ? 0xEDB88320u : 0u);
  }
  return ~value;
}

// A frame being written or read from its start. Little-endian machines only, as nearly all are.
struct Frame {
  std::uint8_t bytes[344 + kTag] = {};
  int at = 0;
  template <class T>
  void put(T value) {
    std::memcpy(bytes + at, &value, sizeof value);
    at += static_cast<int>(sizeof value);
  }
  template <class T>
  T get(int where) const {
    T value;
    std::memcpy(&value, bytes + where, sizeof value);
    return value;
  }
};

struct Force {
  float now[3], x0[3], f0[3], k[9], b[9], radius;
  bool has_model;
};

class Device {
 public:
  // `key`: empty: none.
  Device(int socket, std::string key) : socket_(socket), key_(std::move(key)) { begin_session(); }

  // Receives all pending frames; invalid frames have no effect.
  void hear() {
    Frame frame;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    for (ssize_t got; (got = recvfrom(socket_, frame.bytes, sizeof frame.bytes, MSG_TRUNC,
                                      reinterpret_cast<sockaddr*>(&from), &size)) >= 0;
         size = sizeof from)
      if (whole(frame, got)) accept(frame, from);
    if (engine_ != 0 && now() - heard_at_ > kForget) forget();
  }
  long wrong_key() const { return wrong_key_; }  // frames

  // Sends the handle's position and velocity in metres, Y up.
  void send_state(const float position[3], const float velocity[3]) {
    if (engine_ == 0) return;
    Frame frame = begin(kState, engine_);
    frame.put(heard_);            // the engine's newest frame
    frame.put(std::uint32_t{1});  // 1: ready; 2: stopped; 4: hot; 8: battery low
    frame.put(std::uint32_t{0});  // buttons
    for (int i = 0; i < 3; ++i) frame.put(position[i]);
    for (float part : {1.0f, 0.0f, 0.0f, 0.0f}) frame.put(part);  // rotation w x y z
    for (int i = 0; i < 3; ++i) frame.put(velocity[i]);
    for (int i = 0; i < 3; ++i) frame.put(0.0f);  // spin
    frame.put(0.0f);                              // grip
    send(frame, engine_address_);
  }

  // The force to render: zero unless frames and answers from the engine are recent.
  void render(const float position[3], const float velocity[3], float force[3]) const {
    force[0] = force[1] = force[2] = 0.0f;
    const std::uint32_t next = answered_ + 1;  // the first state that it has not acknowledged
    const double unanswered = answered_ == sent_ ? 0.0 : sent_ - next < 1024 ? now() - sent_at_[next % 1024] : 1e9;
    if (engine_ == 0 || now() - force_at_ > kSilence || unanswered > kAnswer) return;
    float dx[3], far = 0.0f, most = 0.0f;
    for (int i = 0; i < 3; ++i) {
      dx[i] = position[i] - force_.x0[i];
      far += dx[i] * dx[i];
    }
    far = std::sqrt(far);
    for (int i = 0; i < 3; ++i) {
      force[i] = force_.has_model ? force_.f0[i] : force_.now[i];
      if (!force_.has_model) continue;
      for (int j = 0; j < 3; ++j)  // matrices in column-major order
        force[i] += force_.k[3 * j + i] * dx[j] * (far > force_.radius ? force_.radius / far : 1.0f) +
                    force_.b[3 * j + i] * velocity[j];
    }
    for (int i = 0; i < 3; ++i) most += force[i] * force[i];
    if (most = std::sqrt(most); most > kMaxForce)
      for (int i = 0; i < 3; ++i) force[i] *= kMaxForce / most;
  }

 private:
  bool whole(const Frame& frame, ssize_t got) {
    const int kind = frame.bytes[5];
    if (got < 32 || std::memcmp(frame.bytes, "PLNT", 4) != 0 || kind < kAsk || kind > kClose) return false;
    const int length = kLength[kind] + (key_.empty() ? 0 : kTag);
    if (frame.bytes[4] != (key_.empty() ? 1 : 2) || got != length) {
      wrong_key_ += frame.bytes[4] == 1 || frame.bytes[4] == 2;
      return false;
    }
    Frame copy = frame;
    std::memset(copy.bytes + 8, 0, 4);
    if (frame.get<std::uint16_t>(6) != got || frame.get<std::uint32_t>(8) != crc32(copy.bytes, kLength[kind]))
      return false;
#ifdef PLIANT_KEY
    std::uint8_t right[kTag];
    if (!key_.empty()) {
      tag(frame.bytes, kLength[kind], right);
      if (CRYPTO_memcmp(right, frame.bytes + kLength[kind], kTag) != 0) return ++wrong_key_, false;
    }
#endif
    return true;
  }

#ifdef PLIANT_KEY
  void tag(const std::uint8_t* bytes, int size, std::uint8_t out[kTag]) const {
    HMAC(EVP_sha256(), key_.data(), static_cast<int>(key_.size()), bytes, static_cast<std::size_t>(size), out, nullptr);
  }
#endif

  void begin_session() {
    std::random_device random;
    do own_ = random();
    while (own_ == 0);
  }
  // With a key each engine gets a new session, so that a replayed open frame has no effect.
  void forget() {
    engine_ = 0;
    if (!key_.empty()) begin_session();
  }

  void accept(const Frame& frame, const sockaddr_in& from) {
    const auto kind = frame.bytes[5];
    const auto session = frame.get<std::uint32_t>(12), peer = frame.get<std::uint32_t>(16);
    const auto sequence = frame.get<std::uint32_t>(20);
    const auto time = frame.get<std::uint64_t>(24);
    const bool newer = static_cast<std::int32_t>(sequence - heard_) > 0 && time >= heard_time_;
    const bool same = engine_ != 0 && session == engine_ && from.sin_port == engine_address_.sin_port &&
                      from.sin_addr.s_addr == engine_address_.sin_addr.s_addr;
    const bool wants_it = kind == kOpen || (kind == kAsk && !key_.empty());  // with a key, only an engine allowed to
                                                                             // open it may ask
    if (wants_it && engine_ != 0 && !same) return reply_busy(session, from);
    if (kind == kOpen && !key_.empty() && peer != own_) return;
    if (kind == kOpen && engine_ == 0) {
      engine_ = session;
      engine_address_ = from;
      heard_ = sequence;
      heard_time_ = time;
      force_at_ = -1.0;
    } else if (kind != kAsk && !same) {
      return;
    } else if (kind == kOpen && newer) {
      heard_ = sequence;
    }
    if (kind == kAsk || kind == kOpen) return describe(session, from);
    if (peer != own_) return;
    if (kind == kClose) forget();
    if (kind != kForce || !newer) return;
    for (int i = 0; i < 76; ++i)
      if (!std::isfinite(frame.get<float>(40 + 4 * i))) return;
    heard_ = sequence;
    heard_time_ = time;
    answered_ = frame.get<std::uint32_t>(32);
    heard_at_ = force_at_ = now();
    force_.has_model = (frame.get<std::uint32_t>(36) & 1) != 0;
    std::memcpy(force_.now, frame.bytes + 40, 12);
    std::memcpy(&force_.radius, frame.bytes + 68, 4);
    std::memcpy(force_.x0, frame.bytes + 72, 12);
    std::memcpy(force_.f0, frame.bytes + 100, 12);
    std::memcpy(force_.k, frame.bytes + 128, 36);
    std::memcpy(force_.b, frame.bytes + 272, 36);
  }

  void describe(std::uint32_t to, const sockaddr_in& address) {
    if (to == engine_) heard_at_ = now();
    Frame frame = begin(kDescription, to);
    frame.put(std::uint32_t{1 | 8});  // senses position, renders force
    for (float figure : {kMaxForce, 0.0f, 1000.0f, 1.0f, 0.0f, 1000.0f}) frame.put(figure);
    for (int i = 0; i < 3; ++i) frame.put(0.1f);  // half of the workspace
    char name[32] = "example of a network device";
    for (char letter : name) frame.put(letter);
    send(frame, address);
  }

  // Replies that another engine has the device, and which.
  void reply_busy(std::uint32_t to, const sockaddr_in& address) {
    Frame frame = begin(kBusy, to);
    char host[INET_ADDRSTRLEN] = {}, by[64] = {};
    inet_ntop(AF_INET, &engine_address_.sin_addr, host, sizeof host);
    std::snprintf(by, sizeof by, "%s:%d", host, ntohs(engine_address_.sin_port));
    for (char letter : by) frame.put(letter);
    send(frame, address);
  }

  Frame begin(Kind kind, std::uint32_t peer) {
    Frame frame;
    frame.put(std::uint32_t{0x544E4C50});
    frame.put(static_cast<std::uint8_t>(key_.empty() ? 1 : 2));
    frame.put(static_cast<std::uint8_t>(kind));
    frame.put(static_cast<std::uint16_t>(kLength[kind] + (key_.empty() ? 0 : kTag)));
    frame.put(std::uint32_t{0});
    frame.put(own_);
    frame.put(peer);
    frame.put(++sent_);
    frame.put(static_cast<std::uint64_t>((sent_at_[sent_ % 1024] = now()) * 1e6));
    return frame;
  }

  void send(Frame& frame, const sockaddr_in& to) const {
    const std::uint32_t sum = crc32(frame.bytes, frame.at);
    std::memcpy(frame.bytes + 8, &sum, sizeof sum);
#ifdef PLIANT_KEY
    if (!key_.empty()) {
      tag(frame.bytes, frame.at, frame.bytes + frame.at);
      frame.at += kTag;
    }
#endif
    sendto(socket_, frame.bytes, static_cast<std::size_t>(frame.at), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }

  int socket_;
  std::string key_;
  long wrong_key_ = 0;
  std::uint64_t heard_time_ = 0;
  std::uint32_t own_ = 0, engine_ = 0, heard_ = 0, answered_ = 0, sent_ = 0;
  double heard_at_ = -1.0, force_at_ = -1.0, sent_at_[1024] = {};
  sockaddr_in engine_address_{};
  Force force_{};
};

#ifdef PLIANT_KEY
// Returns "" and prints an error if unusable: a key file that everyone may read is rejected.
std::string read_key(const char* path) {
  struct stat about {};
  char bytes[4098];
  std::FILE* const file = std::fopen(path, "rb");
  const bool secret = file && fstat(fileno(file), &about) == 0 && (about.st_mode & (S_IRWXO | S_IWGRP)) == 0;
  std::size_t size = secret ? std::fread(bytes, 1, sizeof bytes, file) : 0;
  if (file) std::fclose(file);
  while (size > 0 && (bytes[size - 1] == '\n' || bytes[size - 1] == '\r')) --size;
  if (size >= 16 && size <= 4096) return {bytes, size};
  std::fprintf(stderr, "network_device: %s holds no key of 16 to 4096 bytes that only you may read (chmod 600)\n",
               path);
  return {};
}
#endif

}  // namespace

int main(int count, char** arguments) {
  std::string key;
#ifdef PLIANT_KEY
  if (count > 2 && (key = read_key(arguments[2])).empty()) return 1;
#endif
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(static_cast<std::uint16_t>(count > 1 ? std::atoi(arguments[1]) : 17716));
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);  // INADDR_ANY: also from other machines
  socklen_t size = sizeof own;
  if (bind(socket, reinterpret_cast<sockaddr*>(&own), size) != 0 || fcntl(socket, F_SETFL, O_NONBLOCK) != 0)
    return std::perror("network_device"), 1;
  getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size);
  std::printf("listening on %d\n", ntohs(own.sin_port));
  std::fflush(stdout);

  Device device(socket, key);
  float position[3] = {0, 0.02f, 0}, velocity[3] = {0, 0, 0}, force[3], largest = 0.0f;
  constexpr float kMass = 0.1f, kSpring = 40.0f, kDamping = 4.0f, kGoal = -0.01f;  // [kg] [N/m] [N s/m] [m]
  double next = now();
  for (long tick = 1;; ++tick) {
    device.hear();
    device.send_state(position, velocity);
    device.render(position, velocity, force);
    for (int i = 0; i < 3; ++i) {
      const float pull = kSpring * ((i == 1 ? kGoal : 0.0f) - position[i]) - kDamping * velocity[i] + force[i];
      velocity[i] += 0.001f / kMass * pull;
      position[i] += 0.001f * velocity[i];
    }
    largest = std::max(largest, std::abs(force[1]));
    if (tick % 1000 == 0) {
      std::printf("y %6.2f mm  force %6.3f N  largest %6.3f N  frames of another key %ld\n", 1e3 * position[1],
                  force[1], largest, device.wrong_key());
      std::fflush(stdout);
    }
    next = std::max(next + 0.001, now());
    const auto wait = std::chrono::duration<double>(next - now());
    pollfd none{};
    if (wait.count() > 0) poll(&none, 0, static_cast<int>(std::ceil(wait.count() * 1e3)));
  }
}
