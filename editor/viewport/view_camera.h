// Points and rays in a perspective or orthographic picture.
#pragma once

#include <optional>

#include "components/mesh.h"
#include "systems/visual/renderer.h"
#include "viewer/hand/camera_control.h"

namespace pliant {

// [m] Height of the orthographic view; at the target it equals the perspective one's.
double orthographic_height(const Viewpoint& view);
// Position of a point in a picture: pixels from the upper left corner, and depth along the view [m]; empty: behind it.
std::optional<dvec3> on_picture(const Viewpoint& view, double orthographic, int width, int height, dvec3 place);
// The ray through a pixel.
ViewRay view_ray(const Viewpoint& view, double orthographic, double x, double y, int width, int height);

}  // namespace pliant
