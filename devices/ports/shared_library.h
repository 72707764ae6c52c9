// A vendor's library, opened at run time. Pliant is built without it and reports missing functions by name.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class SharedLibrary {
 public:
  // Opens the first of `names` that the system finds. The error lists all of them; `cure` tells where to get them.
  static Result<SharedLibrary> open(const std::vector<std::string>& names, const std::string& cure);
  SharedLibrary() = default;
  SharedLibrary(SharedLibrary&& other) noexcept { swap(other); }
  SharedLibrary& operator=(SharedLibrary&& other) noexcept {
    swap(other);
    return *this;
  }
  ~SharedLibrary();

  const std::string& name() const { return name_; }
  // Looks up a function; false: the library does not have it.
  template <class F>
  bool find(const char* symbol, F*& function) const {
    function = reinterpret_cast<F*>(address(symbol));
    return function != nullptr;
  }
  // The same, but records the first missing one: see complete().
  template <class F>
  void need(const char* symbol, F*& function) {
    if (!find(symbol, function) && missing_.empty()) missing_ = symbol;
  }
  Status complete() const;

 private:
  void* address(const char* symbol) const;
  void swap(SharedLibrary& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(name_, other.name_);
    std::swap(missing_, other.missing_);
  }
  void* handle_ = nullptr;
  std::string name_, missing_;
};

}  // namespace pliant
