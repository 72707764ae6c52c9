// In place of isolation.cpp where a process cannot be forked: in a browser, whose sandbox confines a reader that fails.
#include "content/files/isolation.h"

namespace pliant {

Result<Bytes> in_isolation(std::size_t, const std::function<Result<Bytes>()>& work, double, double, double*) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return Error{"", "needs more memory than a file of this size may use", "simplify it, or convert it to glTF"};
  } catch (const std::exception& e) {
    return Error{"", std::string("cannot be read: ") + e.what()};
  }
}

}  // namespace pliant
