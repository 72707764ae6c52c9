// Reflectance of a rough coat under uniform surroundings: the second factor of the split sum (Karis, Real Shading in
// Unreal Engine 4, SIGGRAPH 2013), as a table. Rejected: a closed-form fit, which was up to 25 % too dark at medium
// roughness.
#pragma once

#include <vector>

#include "components/math.h"

namespace pliant {

// (A, B): the coat's directional reflectance is A f0 + B. `n_v`: cosine between normal and eye, in (0, 1]; `roughness`
// perceptual, in [0, 1]. GGX with height-correlated shadowing, as in shaders/light.glsl; importance sampled.
vec2 coat_reflectance(double n_v, double roughness, int samples);

// size x size values at texel centres: columns n_v from 0 to 1, rows roughness from 0 to 1.
std::vector<vec2> coat_table(int size);

}  // namespace pliant
