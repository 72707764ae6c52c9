// Scripts that repeat while a window is open.
#pragma once

#include "components/world.h"

namespace pliant {

// `path` from time 0 on, made repeatable. If it is not closed it is followed back in reverse, since no other way is
// known to be free. At least `period` [s] long: it waits at its start for the remaining time.
Path repeated(const Path& path, double period);

// Its length without waiting. [s]
double period_of(const Path& path);

// Gives every scripted device a path that repeats. All paths start over at the same time, so that probes that meet in
// the script meet every time. Poses stay continuous: no force jumps where a script starts over.
void repeat_scripts(World& world);

}  // namespace pliant
