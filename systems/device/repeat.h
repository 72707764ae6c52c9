// Scripts that go on for as long as a window is open.
#pragma once

#include "components/world.h"

namespace pliant {

// `path` from time 0 on, so that it can start over: where it does not end as it begins, it is followed back in reverse,
// as no other way is known to be free. At least `period` [s] long: it waits at its start for what is longer.
Path repeated(const Path& path, double period);

// How long that takes without waiting. [s]
double period_of(const Path& path);

// Gives every device that follows a script a path that starts over, all at the same time, so that probes that meet in
// the script meet every time. Poses stay continuous: no force jumps where a script starts over.
void repeat_scripts(World& world);

}  // namespace pliant
