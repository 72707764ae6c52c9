// Choice among Debian 12's libraries: libwebsockets is a C library that compiles quickly and is maintained. websocketpp
// has had no release since 2020; Boost's Beast takes half a minute and a gigabyte to compile.
#include "devices/ports/web_socket_port.h"

#include <libwebsockets.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <deque>
#include <mutex>
#include <vector>

#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr std::size_t kMostWaiting = 64;  // unread messages; beyond it the oldest are lost

int on_event(lws* socket, lws_callback_reasons reason, void*, void* data, std::size_t size);
const lws_protocols kProtocols[] = {{"", on_event, 0, 4096, 0, nullptr, 0}, {nullptr, nullptr, 0, 0, 0, nullptr, 0}};

}  // namespace

struct WebSocketPort::Line {
  std::string name, fault;
  std::size_t longest = 0;
  lws_context* context = nullptr;
  lws* socket = nullptr;
  bool connected = false, ended = false;
  std::vector<std::uint8_t> out, in;  // out: after LWS_PRE bytes for the library
  bool to_write = false;
  std::deque<std::vector<std::uint8_t>> messages;
  struct Timer {
    lws_sorted_usec_list_t entry{};
    bool rung = false;
  } timer;

  ~Line() {
    if (context) lws_context_destroy(context);
  }

  // Runs the library until `done`, the end of the connection, or the time-out.
  template <class F>
  void work(double seconds, F&& done) {
    lws_service(context, -1);  // only pending work
    if (done() || ended || seconds <= 0.0) return;
    timer.rung = false;
    lws_sul_schedule(
        context, 0, &timer.entry,
        [](lws_sorted_usec_list_t* entry) { lws_container_of(entry, Timer, entry)->rung = true; },
        static_cast<lws_usec_t>(std::min(seconds, 1e6) * 1e6));
    while (!done() && !ended && !timer.rung) lws_service(context, 0);
    if (!timer.rung) lws_sul_schedule(context, 0, &timer.entry, nullptr, LWS_SET_TIMER_USEC_CANCEL);
  }
  void end(const std::string& why) {
    if (!ended) fault = why;
    ended = true;
  }
  Error error() const { return {name, fault}; }
};

namespace {

int on_event(lws* socket, lws_callback_reasons reason, void*, void* data, std::size_t size) {
  lws_context* context = lws_get_context(socket);
  auto* line = context ? static_cast<WebSocketPort::Line*>(lws_context_user(context)) : nullptr;
  if (!line) return 0;
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      line->connected = true;
      break;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
      line->end(data ? std::string(static_cast<const char*>(data), size) : std::string("refused"));
      break;
    case LWS_CALLBACK_CLIENT_CLOSED:
      line->end("has closed the line");
      break;
    case LWS_CALLBACK_CLIENT_RECEIVE: {
      if (line->in.size() + size + lws_remaining_packet_payload(socket) > line->longest) {
        line->end("has sent a message of more than " + std::to_string(line->longest / 1024) + " KiB");
        return -1;
      }
      const auto* bytes = static_cast<const std::uint8_t*>(data);
      line->in.insert(line->in.end(), bytes, bytes + size);
      if (!lws_is_final_fragment(socket)) break;
      if (line->messages.size() == kMostWaiting) line->messages.pop_front();
      line->messages.push_back(line->in);
      line->in.clear();
      break;
    }
    case LWS_CALLBACK_CLIENT_WRITEABLE: {
      if (!line->to_write) break;
      line->to_write = false;
      const std::size_t length = line->out.size() - LWS_PRE;
      if (lws_write(socket, line->out.data() + LWS_PRE, length, LWS_WRITE_TEXT) < static_cast<int>(length)) {
        line->end("does not take what is sent");
        return -1;
      }
      break;
    }
    default:
      break;
  }
  return 0;
}

}  // namespace

WebSocketPort::WebSocketPort(std::unique_ptr<Line> line) : line_(std::move(line)) {}
WebSocketPort::~WebSocketPort() = default;

Result<std::unique_ptr<WebSocketPort>> WebSocketPort::connect(const std::string& host, int port, double seconds,
                                                              std::size_t longest) {
  static std::once_flag quiet;
  std::call_once(quiet, [] { lws_set_log_level(0, nullptr); });
  auto line = std::make_unique<Line>();
  line->name = host + ":" + std::to_string(port);
  line->longest = longest;
  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = kProtocols;
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  info.user = line.get();
  info.fd_limit_per_thread = 16;  // otherwise it allocates a table for as many files as the system allows
  struct sigaction pipe {};       // the library ignores SIGPIPE from here on, which is the program's decision; it sends
                                  // without the signal
  ::sigaction(SIGPIPE, nullptr, &pipe);
  line->context = lws_create_context(&info);
  ::sigaction(SIGPIPE, &pipe, nullptr);
  if (!line->context) return Error{line->name, "libwebsockets could not begin", "is memory or are files exhausted?"};
  lws_client_connect_info to{};
  to.context = line->context;
  to.address = to.host = to.origin = host.c_str();
  to.port = port;
  to.path = "/";
  to.pwsi = &line->socket;
  if (!lws_client_connect_via_info(&to) && !line->ended) line->end("refused");
  line->work(seconds, [&] { return line->connected; });
  if (!line->connected && !line->ended) line->end("does not answer");
  if (line->ended) return line->error();
  return std::unique_ptr<WebSocketPort>(new WebSocketPort(std::move(line)));
}

int WebSocketPort::file() const {
  return line_->ended ? -1 : lws_get_socket_fd(line_->socket);
}

std::size_t web_socket_frame(std::span<const std::uint8_t> text, std::span<std::uint8_t> into) {
  constexpr std::size_t kShort = 125;
  const bool is_short = text.size() <= kShort;
  const std::size_t head = (is_short ? 2 : 4) + 4;
  if (text.size() > 0xffff || head + text.size() > into.size()) return 0;
  std::fill_n(into.begin(), head, std::uint8_t(0));
  into[0] = 0x81;
  into[1] = static_cast<std::uint8_t>(0x80 | (is_short ? text.size() : 126));
  if (!is_short) {
    into[2] = static_cast<std::uint8_t>(text.size() >> 8);
    into[3] = static_cast<std::uint8_t>(text.size());
  }
  std::copy(text.begin(), text.end(), into.begin() + static_cast<std::ptrdiff_t>(head));
  return head + text.size();
}

Status WebSocketPort::send(std::span<const std::uint8_t> text) {
  if (!line_->ended) {
    line_->out.resize(LWS_PRE + text.size());
    std::memcpy(line_->out.data() + LWS_PRE, text.data(), text.size());
    line_->to_write = true;
    lws_callback_on_writable(line_->socket);
    line_->work(1.0, [&] { return !line_->to_write; });
    if (line_->to_write) line_->end("does not take what is sent");
  }
  if (line_->ended) return line_->error();
  return Done{};
}

Result<std::size_t> WebSocketPort::receive(std::span<std::uint8_t> into, double seconds) {
  if (line_->messages.empty() && !line_->ended) line_->work(seconds, [&] { return !line_->messages.empty(); });
  if (line_->messages.empty()) {
    if (line_->ended) return line_->error();
    return std::size_t{0};
  }
  const std::vector<std::uint8_t>& first = line_->messages.front();
  const std::size_t size = std::min(first.size(), into.size());
  std::copy_n(first.begin(), size, into.begin());
  line_->messages.pop_front();
  return size;
}

}  // namespace pliant
