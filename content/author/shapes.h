// Simple closed shapes with texture coordinates, to build scenes from. All about the origin.
#pragma once

#include <span>

#include "content/level/level.h"

namespace pliant {

enum class ShapeKind : std::uint8_t { kSphere, kBox, kPlate, kTorus };

struct SimpleShape {
  ShapeKind kind;
  const char* word;
  const char* about;
};
std::span<const SimpleShape> shapes();

// `size` [m]: its largest extent. A plate is a tenth as thick (y) as it is wide; a torus lies flat, its tube half as
// thick as its ring's radius. Positions at seams are equal bit for bit, so that they weld.
Primitive shape_of(ShapeKind kind, double size);

}  // namespace pliant
