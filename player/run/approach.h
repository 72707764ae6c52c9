// How near a probe that touched nothing came to what it could have touched. Its path is kept in bounded memory; the
// nearest place of a surface is looked for once, after the run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/world.h"

namespace pliant {

// What can be touched, as it stands before the clock starts: whoever keeps rows may not read the world meanwhile.
struct TouchableBox {
  Pose pose;
  Box box;  // [m] object frame
};
std::vector<TouchableBox> touchable_boxes(const World& world);

class Approach {
 public:
  static constexpr std::size_t kKept = 512;

  // [m] world. Of every few ticks, the place that is nearest to a box stays.
  void add(dvec3 position, const std::vector<TouchableBox>& boxes);

  struct Place {
    dvec3 position{0};  // [m] world
    double bound = 0;   // [m] no surface is nearer than this
  };
  const std::vector<Place>& places() const { return places_; }

 private:
  std::vector<Place> places_;
  std::size_t stride_ = 1, filled_ = 0;  // ticks that share a place; of the newest place, so far
};

struct Miss {
  std::string object;        // the nearest
  double distance = 0.0;     // [m] between it and the probe's sphere
  double diagonal = 0.0;     // [m] of its bounds
  std::size_t vertices = 0;  // of its mesh
  bool behind = false;       // it has been behind that surface: through its back, or in another probe's dent
};
// Nothing where there is no surface, or the probe was nowhere.
std::optional<Miss> find_miss(const World& world, const Approach& approach, double radius);

// What to say of it.
std::string explain_miss(const std::string& probe, const std::optional<Miss>& miss);

}  // namespace pliant
