// Haply's Inverse Service by its published protocol: an inventory on connection, then exactly one state for each
// message. Runs on a separate thread, on a loopback port.
#pragma once

#include <libwebsockets.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace pliant {

class FakeHaplyService {
 public:
  explicit FakeHaplyService(int on = 0) {
    lws_set_log_level(0, nullptr);
    lws_context_creation_info info{};
    info.port = on;
    info.iface = "lo";
    info.protocols = protocols();
    info.gid = static_cast<gid_t>(-1);
    info.uid = static_cast<uid_t>(-1);
    info.user = this;
    info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
    info.fd_limit_per_thread = 32;
    context_ = lws_create_context(&info);
    lws_vhost* host = lws_create_vhost(context_, &info);
    port = host ? lws_get_vhost_listen_port(host) : 0;
    thread_ = std::thread([this] {
      while (!stop_) lws_service(context_, 0);
    });
  }
  ~FakeHaplyService() {
    stop_ = true;
    lws_cancel_service(context_);
    thread_.join();
    lws_context_destroy(context_);
  }

  int port = 0;
  // Shared with the tests.
  std::mutex mutex;
  nlohmann::json state = {{"cursor_position", {{"x", 0.0}, {"y", -0.12}, {"z", 0.15}}},
                          {"cursor_velocity", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}};
  nlohmann::json status = {{"calibrated", true}, {"ready", true}};
  nlohmann::json grip;   // its state; null: none
  std::string instead;   // sent in place of a state, where it is not empty
  nlohmann::json force;  // commanded last
  std::atomic<int> asked = 0, answered = 0, sessions = 0;
  bool unplugged = false;

  std::string message(bool inventory) {
    const std::lock_guard lock(mutex);
    if (!instead.empty() && !inventory) return instead;
    nlohmann::json all = {{"session_id", 7}, {"inverse3", nlohmann::json::array()}};
    nlohmann::json device = {{"device_id", "049D"}, {"state", state}, {"status", status}};
    if (inventory) device["config"] = {{"type", "inverse3"}, {"port", "COM12"}, {"handedness", "right"}};
    if (!unplugged) all["inverse3"].push_back(device);
    if (!grip.is_null()) all["wireless_verse_grip"] = {{{"device_id", "61576"}, {"state", grip}}};
    return all.dump();
  }

 private:
  struct Client {
    int owed;  // states
    bool greeted;
  };
  static const lws_protocols* protocols() {
    static const lws_protocols all[] = {{"simulation", on_event, sizeof(Client), 4096, 0, nullptr, 0},
                                        {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
    return all;
  }
  static int on_event(lws* socket, lws_callback_reasons reason, void* user, void* data, std::size_t size) {
    auto* service = static_cast<FakeHaplyService*>(lws_context_user(lws_get_context(socket)));
    auto* client = static_cast<Client*>(user);
    switch (reason) {
      case LWS_CALLBACK_ESTABLISHED:
        *client = {0, false};
        lws_callback_on_writable(socket);
        break;
      case LWS_CALLBACK_RECEIVE: {
        const nlohmann::json sent =
            nlohmann::json::parse(std::string(static_cast<const char*>(data), size), nullptr, false);
        const std::lock_guard lock(service->mutex);
        ++service->asked;
        ++client->owed;
        if (sent.contains("session")) ++service->sessions;
        if (sent.is_object() && sent.value("/inverse3/0/device_id"_json_pointer, "") == "049D")
          service->force = sent.value("/inverse3/0/commands/set_cursor_force/values"_json_pointer, nlohmann::json());
        lws_callback_on_writable(socket);
        break;
      }
      case LWS_CALLBACK_SERVER_WRITEABLE: {
        if (client->greeted && client->owed == 0) break;
        const std::string text = service->message(!client->greeted);
        if (client->greeted) {
          --client->owed;
          ++service->answered;
        }
        client->greeted = true;
        std::string framed(LWS_PRE, '\0');
        framed += text;
        lws_write(socket, reinterpret_cast<unsigned char*>(framed.data()) + LWS_PRE, text.size(), LWS_WRITE_TEXT);
        if (client->owed > 0) lws_callback_on_writable(socket);
        break;
      }
      default:
        break;
    }
    return 0;
  }

  lws_context* context_ = nullptr;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace pliant
