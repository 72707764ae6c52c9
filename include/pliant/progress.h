// How far a long call has come: Session::open and load_scene.
#pragma once

#include <functional>
#include <string>

namespace pliant {

// On the thread that called, some fifty times a second at most. `share` [1] of the whole is done, as far as it can be
// known, and never falls; `doing` says what is under way: "preparing meshes, now `heart`". False: stop; the call
// returns an Error within a fraction of a second, and nothing is left of what it made. It must not throw.
using OpenProgress = std::function<bool(double share, const std::string& doing)>;

}  // namespace pliant
