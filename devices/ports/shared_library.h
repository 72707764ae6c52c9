// A maker's library, opened at run time: Pliant is built without it and says by name what is missing.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class SharedLibrary {
 public:
  // The first of `names` that the system finds. The error names all of them, and `cure` says where they come from.
  static Result<SharedLibrary> open(const std::vector<std::string>& names, const std::string& cure);
  SharedLibrary() = default;
  SharedLibrary(SharedLibrary&& other) noexcept { swap(other); }
  SharedLibrary& operator=(SharedLibrary&& other) noexcept {
    swap(other);
    return *this;
  }
  ~SharedLibrary();

  const std::string& name() const { return name_; }
  // The function of this name into `function`; false: the library has none.
  template <class F>
  bool find(const char* symbol, F*& function) const {
    function = reinterpret_cast<F*>(address(symbol));
    return function != nullptr;
  }
  // Likewise, and remembers the first that is missing: see complete().
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
