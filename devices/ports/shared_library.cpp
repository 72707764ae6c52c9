#include "devices/ports/shared_library.h"

#include <dlfcn.h>

namespace pliant {

Result<SharedLibrary> SharedLibrary::open(const std::vector<std::string>& names, const std::string& cure) {
  std::string why, tried;
  for (const std::string& name : names) {
    SharedLibrary library;
    library.handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    library.name_ = name;
    if (library.handle_) return library;
    const char* said = dlerror();
    // Prefer the error of a file that exists but cannot be loaded.
    const std::string reason = said ? said : "";
    if (reason.find("No such file") == std::string::npos) why = " (" + reason + ")";
    tried += (tried.empty() ? "" : ", ") + name;
  }
  return Error{tried, "is not installed or cannot be loaded" + why, cure};
}

SharedLibrary::~SharedLibrary() {
  if (handle_) dlclose(handle_);
}

void* SharedLibrary::address(const char* symbol) const {
  return handle_ ? dlsym(handle_, symbol) : nullptr;
}

Status SharedLibrary::complete() const {
  if (missing_.empty()) return Done{};
  return Error{name_, "has no function `" + missing_ + "`", "install a newer version of it"};
}

}  // namespace pliant
