// Distance of a probe without contact from the nearest surface. Its path is stored in bounded memory; the nearest
// surface point is searched once, after the run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/world.h"

namespace pliant {

// A touchable surface before the clocks start: the keeper may not read the world while they run.
struct TouchableBox {
  Pose pose;
  Box box;  // [m] object frame
};
std::vector<TouchableBox> touchable_boxes(const World& world);

class Approach {
 public:
  static constexpr std::size_t kKept = 512;

  // [m] world. Of every few ticks, only the place nearest to a box is kept.
  void add(dvec3 position, const std::vector<TouchableBox>& boxes);

  struct Place {
    dvec3 position{0};  // [m] world
    double bound = 0;   // [m] lower bound of the distance to any surface
  };
  const std::vector<Place>& places() const { return places_; }

 private:
  std::vector<Place> places_;
  std::size_t stride_ = 1, filled_ = 0;  // ticks merged into one place; of these, ticks already in the newest place
};

struct Miss {
  std::string object;        // the nearest object
  double distance = 0.0;     // [m] from it to the probe's sphere
  double diagonal = 0.0;     // [m] of its bounds
  std::size_t vertices = 0;  // of its mesh
  bool behind = false;       // the probe has been behind that surface: through its back, or in another probe's dent
};
// Empty if there is no surface, or the probe has no place.
std::optional<Miss> find_miss(const World& world, const Approach& approach, double radius);

// Code of a probe or tool that never touched anything.
inline constexpr const char* kUntouched = "run.untouched";
Note explain_miss(const std::string& probe, const std::optional<Miss>& miss);

}  // namespace pliant
