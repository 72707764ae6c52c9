// The brush drawn at the mouse while painting.
#pragma once

#include <string>

#include "editor/core/painting.h"
#include "editor/tools/tools.h"

namespace pliant {

// The brush's rim: a circle in the tangent plane, laid onto the surface.
void draw_ring(const Painting& painting, const PaintSurface& surface, const SurfaceHit& hit, const ViewportInput& in,
               ImDrawList& list, float strength);
// The line from where the gradient begins to the mouse.
void draw_gradient(const Painting& painting, const SurfaceHit& hit, const ViewportInput& in, ImDrawList& list);
void say_at_mouse(const ViewportInput& in, ImDrawList& list, const std::string& text, bool warns);

}  // namespace pliant
