// Progress of the long calls Session::open and load_scene.
#pragma once

#include <functional>
#include <string>

namespace pliant {

// Called on the calling thread, at most some fifty times a second. `share` [1]: estimated completed share, never
// decreases. `doing`: the current step: "preparing meshes, now `heart`". Return false to cancel: the call returns an
// Error within a fraction of a second and discards its work. Must not throw.
using OpenProgress = std::function<bool(double share, const std::string& doing)>;

}  // namespace pliant
