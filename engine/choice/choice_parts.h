// The parts of model_choice.h, one a kind of object.
#pragma once

#include "components/world.h"
#include "engine/choice/model_choice.h"

namespace pliant {

// A world of this node alone, at its place, without what moves it; a soft body's lattice of `cell` [m], 0: the usual.
Result<World> spawn_alone(const Level& level, std::size_t node, double cell = 0.0);
// Whether a key is the author's: said in the file, by --set, or not at its default.
bool states(const LevelNode& node, const std::string& extension, const std::string& key);
bool states_step(const Level& level);

// The half-space's surface under a flat punch of this radius [m]: the share of the depth at distance r [m].
double punch_share(double r, double radius);
// One press of the engine's own tick at a vertex of the only surface of `world`, `depth` [m] deep: the RMS difference
// from the half-space over its RMS within the reach, weighted by area. Empty where the press did not touch.
struct SurfacePress {
  double off = 0.0, size = 0.0;  // sums of squares
  double vertices = 0.0;         // awake
  double ms = 0.0;               // of the tick
};
Result<SurfacePress> press_vertex(World& world, std::uint32_t vertex, double depth);
Result<ModelChoice> choose_surface(Level& level, std::size_t node);

// [1] How far the lattice of `cell` [m] is from the finest in answer to the same presses, and the soft step from the
// midpoint rule in short ones. `step` [s] is what the bodies of the level need.
Result<ModelChoice> choose_body(Level& level, std::size_t node, double& step);

}  // namespace pliant
