// For measuring costs: CPU time that other threads spent on this thread's tasks (tasks.h).
#pragma once

#include <cstdint>

namespace pliant {

std::uint64_t helped_ns();  // [ns] since the thread began

}  // namespace pliant
