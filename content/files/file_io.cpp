#include "content/files/file_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace pliant {

namespace fs = std::filesystem;

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

constexpr int kMostAside = 100;  // names

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Result<Bytes> read_file(const fs::path& path, const Limit& limit) {
  return read_beginning(path, limit, UINT64_MAX);
}

Result<Bytes> read_beginning(const fs::path& path, const Limit& limit, std::uint64_t wanted) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error || !fs::exists(status)) return Error{path.string(), "no such file", "check the path", "file.missing"};
  if (!fs::is_regular_file(status)) return Error{path.string(), "is not a regular file", "name a file"};
  const std::uint64_t size = std::min<std::uint64_t>(fs::file_size(path, error), wanted);
  if (error) return Error{path.string(), "its size cannot be read: " + error.message(), "check the path"};
  if (size > most(limit))
    return error_at(path.string(), beyond("has", limit, static_cast<double>(size), "use a smaller file"));
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file)
    return Error{path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)), "check its permissions"};
  Bytes bytes(size);
  if (std::fread(bytes.data(), 1, size, file.get()) != size)
    return Error{path.string(), "could not be read to its end", "check the disk"};
  return bytes;
}

Error not_written(std::string where, const std::string& what, int error) {
  const char *cure = "check the folder and its permissions", *code = kDiskFull;
  if (error == ENOSPC || error == EDQUOT) cure = "free some space";
  if (error == EFBIG) cure = "raise the limit on the size of a file (`ulimit -f`)";
  if (error != ENOSPC && error != EDQUOT && error != EFBIG) code = "file.unwritable";
  return {std::move(where), what + ": " + std::generic_category().message(error), cure, code};
}

fs::path numbered(const fs::path& path, int number) {
  return fs::path(path).replace_filename(
      fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string()));
}

int move_file(const fs::path& from, const fs::path& to, bool replace) {
  if (!replace) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    std::error_code error;  // a file system without atomic rename-without-replace
    if (fs::symlink_status(to, error).type() != fs::file_type::not_found) return EEXIST;
  }
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

fs::path aside_of(const fs::path& path) {
  return fs::path(path).concat(fmt::format(".{}.part", ::getpid()));
}

namespace {

// Creates a file under the first free name. Never follows a link, never overwrites a file. Null: see errno.
File open_aside(const fs::path& path, fs::path& aside) {
  aside = aside_of(path);
  for (int n = 2;; ++n) {
    const int file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) return File(::fdopen(file, "wb"));
    if (errno != EEXIST || n > kMostAside) return nullptr;
    aside = fs::path(path).concat(fmt::format(".{}-{}.part", ::getpid(), n));
  }
}

// A file about to be replaced, and its backup name; "" if no backup could be made.
struct Replaced {
  bool was_there = false;
  fs::path kept;
};
Replaced keep_beside(const fs::path& path) {
  std::error_code ignored;
  Replaced out{fs::exists(fs::symlink_status(path, ignored)), {}};
  for (int n = 1; out.was_there && n <= kMostAside; ++n) {
    const fs::path name = fs::path(path).concat(fmt::format(".{}-{}.old", ::getpid(), n));
    if (::link(path.c_str(), name.c_str()) == 0) {
      out.kept = name;
      break;
    }
    if (errno != EEXIST) break;
  }
  return out;
}
void forget(const std::vector<Replaced>& all) {
  std::error_code ignored;
  for (const Replaced& each : all)
    if (!each.kept.empty()) fs::remove(each.kept, ignored);
}

}  // namespace

Status write_files(const std::vector<FileToWrite>& files, Existing existing) {
  std::error_code ignored;
  const auto taken = [](const fs::path& path) {
    return Error{path.string(), "is there already", "name another, or replace it with --force"};
  };
  for (const FileToWrite& each : files) {
    if (existing == Existing::kRefuse && fs::exists(fs::symlink_status(each.path, ignored))) return taken(each.path);
    if (fs::is_directory(fs::symlink_status(each.path, ignored)))
      return Error{each.path.string(), "is a folder", "name a file"};
  }
  std::vector<fs::path> aside;
  const auto fail = [&](const fs::path& path, const char* what) {
    Error error = not_written(path.string(), what, errno);
    for (const fs::path& each : aside) fs::remove(each, ignored);
    return error;
  };
  for (const FileToWrite& each : files) {
    fs::path name;
    File file = open_aside(each.path, name);
    if (!file) return fail(each.path, "cannot be written");
    aside.push_back(name);
    // Flush before closing: a full disk may only be reported here, and closing may hide the reason.
    if (std::fwrite(each.bytes.data(), 1, each.bytes.size(), file.get()) != each.bytes.size() ||
        std::fflush(file.get()) != 0 || std::fclose(file.release()) != 0)
      return fail(each.path, "could not be written to its end");
  }
  // Replaced files are kept under backup names until the last file is in place.
  std::vector<Replaced> replaced;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (i + 1 < files.size()) replaced.push_back(keep_beside(files[i].path));
    errno = move_file(aside[i], files[i].path, existing == Existing::kReplace);
    if (errno == 0) continue;
    const Error error = fail(files[i].path, "cannot be put in place");
    for (std::size_t k = 0; k < i; ++k) {
      if (!replaced[k].kept.empty()) fs::rename(replaced[k].kept, files[k].path, ignored);
      if (!replaced[k].was_there) fs::remove(files[k].path, ignored);
    }
    forget(replaced);
    return error;
  }
  forget(replaced);
  return Done{};
}

Status write_file(const fs::path& path, std::span<const std::uint8_t> bytes, Existing existing) {
  return write_files({{path, bytes}}, existing);
}

Result<fs::path> confined_file(const fs::path& folder, const fs::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return Error{folder.string(), "cannot be resolved: " + error.message(), "check the path"};
  const fs::path whole = fs::weakly_canonical(root / file, error);
  if (error) return Error{name, "cannot be resolved: " + error.message(), "check the path"};
  const fs::path from_root = whole.lexically_relative(root);
  if (file.is_absolute() || from_root.empty() || *from_root.begin() == "..")
    return Error{name, "lies outside the level's folder, where a level may not reach",
                 "copy the file beside the level"};
  return whole;
}

Result<fs::path> confined_path(const fs::path& folder, const std::string& uri) {
  if (uri.empty()) return Error{uri, "is an empty URI", "name a file"};
  const auto confined = [&](const std::string& name) -> Result<fs::path> {
    if (name.find('\0') != std::string::npos) return Error{"URI", "contains a zero byte", "name a file"};
    // A colon before any slash makes a scheme (RFC 3986, 4.2).
    const std::size_t colon = name.find(':');
    if (colon != std::string::npos && name.find('/') > colon)
      return Error{uri, "names another place than the level's folder", "put the file beside the level"};
    return confined_file(folder, name);
  };
  // A file name may contain a literal %; scripts and panoramas are named without encoding.
  std::error_code ignored;
  if (const Result<fs::path> as_it_is = confined(uri); uri.find('%') == std::string::npos || !as_it_is)
    return as_it_is;
  else if (fs::exists(*as_it_is, ignored))
    return as_it_is;
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0)
      return Error{uri, "is not a valid URI (a % without two hexadecimal digits)", "write %25 for a % in a name"};
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return confined(decoded);
}

}  // namespace pliant
