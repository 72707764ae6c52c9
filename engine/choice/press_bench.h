// An isolated object with its own probes, pressed by the touch tick at several places.
#pragma once

#include <cstdint>
#include <vector>

#include "components/world.h"
#include "engine/choice/surface_truth.h"
#include "runtime/result.h"
#include "runtime/schedule.h"

namespace pliant {

// Places of the presses, the same for every mesh that `reach` makes of the object. Object frame.
struct PressPlaces {
  std::vector<dvec3> foot, normal;  // [m], unit
};
inline constexpr std::size_t kPressPlaces = 6;
// Places spread over the mesh's vertex order, in which near numbers are near in space.
PressPlaces press_places(const Mesh& mesh);

class PressBench {
 public:
  // `level`: of level_alone(), with the node edited. Probes of this radius [m]; 0: points.
  static Result<PressBench> make(const Level& level, const PressPlaces* places, double probe_radius);

  Deformable& surface() { return world_.registry.get<Deformable>(object_); }
  const Mesh& mesh() const { return world_.meshes[world_.registry.get<Deformable>(object_).mesh]; }
  const PressPlaces& places() const { return places_; }

  // Call after `distance` or the law has changed; other keys of surface() need no call. No place may have been pressed
  // before.
  [[nodiscard]] Status prepare();

  // Result of pressing one place `depth` [m] deep and releasing it; afterwards the surface is at rest.
  struct Press {
    double off = 0.0, size = 0.0;  // area-weighted sums of squares in the region: difference, reference
    double vertices = 0.0;         // awake
    double force = 0.0;            // [N] along the normal
    double ms = 0.0;               // of the tick
  };
  Press press(std::size_t place, double depth, const SurfaceTruth& truth);

 private:
  // Comparison data of a place: vertices within the region, and the reference there.
  struct Region {
    bool known = false;
    std::vector<std::uint32_t> vertex;
    std::vector<double> share;  // [1]
  };
  void tick(std::size_t place, double depth);  // the others stay outside
  void find_region(std::size_t place, const Contact& contact, const SurfaceTruth& truth);

  World world_;
  Entity object_;
  std::vector<Entity> probes_;
  PressPlaces places_;
  std::vector<Region> regions_;
  Schedule<World> schedule_{{}};
  double probe_radius_ = 0.0;
  double aside_ = 0.0;  // [m] distance from the surface at which idle probes wait
  std::uint64_t ticks_ = 0;
  double ms_ = 0.0;  // of the last tick
};

}  // namespace pliant
