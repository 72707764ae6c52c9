#include "content/files/limits.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "pliant/content.h"

namespace pliant {
namespace {
std::atomic<double> g_factor{1.0};  // set once, before any file is read
}

void set_limit_factor(double factor) {
  g_factor = kLimitFactor.holds(factor) ? factor : 1.0;
}

double limit_factor() {
  return g_factor;
}

std::uint64_t most(const Limit& limit) {
  return static_cast<std::uint64_t>(limit.scales ? limit.most * g_factor : limit.most);
}

Note beyond(const std::string& what, const Limit& limit, double found, const std::string& cure) {
  Note note{fmt::format("{} {:.0f} {}, more than the {} that are taken ({})", what, found, limit.unit, most(limit),
                        limit.reason),
            cure,
            "limit.exceeded",
            {}};
  if (limit.scales && found <= limit.most * kLimitFactor.max)
    note.cure += fmt::format(", or allow it with --limits {}", std::ceil(found / limit.most));
  return note;
}

}  // namespace pliant
