#include "editor/document/file_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pwd.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "content/files/file_io.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Field 22 of /proc/PID/stat; 0: no such process. The second field may contain spaces and brackets.
std::uint64_t start_of(int process) {
  std::ifstream in(fmt::format("/proc/{}/stat", process));
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::size_t bracket = text.rfind(')');
  if (bracket == std::string::npos) return 0;
  std::istringstream fields(text.substr(bracket + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i)
    if (!(fields >> field)) return 0;
  return std::strtoull(field.c_str(), nullptr, 10);
}

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string user_name() {
  const passwd* const entry = ::getpwuid(::getuid());
  return entry ? entry->pw_name : std::to_string(::getuid());
}

std::optional<LockHolder> read_lock(const fs::path& lock) {
  const Result<Bytes> bytes = read_file(lock);
  const Json json = bytes ? Json::parse(bytes->begin(), bytes->end(), nullptr, false) : Json();
  if (!json.is_object()) return {};
  LockHolder holder;
  try {
    holder.process = json.at("process").get<int>();
    holder.started = json.at("started").get<std::uint64_t>();
    holder.host = json.at("host").get<std::string>();
    holder.user = json.at("user").get<std::string>();
    holder.since = json.at("since").get<std::string>();
  } catch (const Json::exception&) {
    return {};
  }
  return holder;
}

bool runs(const LockHolder& holder) {
  if (holder.host != host_name()) return true;  // a process on another host cannot be checked
  return holder.process > 0 && start_of(holder.process) == holder.started;
}

}  // namespace

fs::path lock_of(const fs::path& file) {
  return file.parent_path() / ("." + file.filename().string() + ".lock");
}

std::optional<LockHolder> lock_holder(const fs::path& file) {
  std::optional<LockHolder> holder = read_lock(lock_of(file));
  if (!holder || !runs(*holder)) return {};
  if (holder->host == host_name() && holder->process == ::getpid()) return {};
  return holder;
}

std::string text_of(const LockHolder& holder) {
  return printable(
      fmt::format("{} on {} (process {}), since {}", holder.user, holder.host, holder.process, holder.since));
}

FileLock::FileLock(const fs::path& file) : lock_(lock_of(file)) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  const Json json{{"process", static_cast<int>(::getpid())},
                  {"started", start_of(::getpid())},
                  {"host", host_name()},
                  {"user", user_name()},
                  {"since", fmt::format("{:%Y-%m-%d %H:%M}", local)}};
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  // Written to a temporary file and linked: it appears atomically, and only one of two concurrent attempts succeeds.
  const fs::path aside = fs::path(lock_).concat(fmt::format(".{}", ::getpid()));
  {
    std::ofstream out(aside, std::ios::trunc);
    if (!(out << text) || !out.flush()) return;
  }
  std::error_code failed;
  for (int tries = 0; tries < 2 && !held_; ++tries) {
    held_ = ::link(aside.c_str(), lock_.c_str()) == 0;
    if (held_ || errno != EEXIST || lock_holder(file)) break;
    took_over_ = fs::remove(lock_, failed);
  }
  if (!held_) took_over_ = false;
  fs::remove(aside, failed);
}

FileLock::~FileLock() {
  if (!held_) return;
  const std::optional<LockHolder> now = read_lock(lock_);  // unless it was replaced by hand
  std::error_code gone;
  if (now && now->process == ::getpid() && now->host == host_name()) std::filesystem::remove(lock_, gone);
}

}  // namespace pliant
