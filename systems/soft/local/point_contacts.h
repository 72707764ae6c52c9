// Contacts of meshes with split tissue (methods.md 2.10). Of two bodies the one of smaller surface presses with points
// of it (pressed_points.h), each on the other's surface without its dent, along that surface's normal. A point's part
// of the area, seen along the normal, is its contact's. Writer: the soft clock.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "systems/soft/collide/contact_memory.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/local/pressed_points.h"

namespace pliant {

class PointContacts {
 public:
  // Of bodies that may be pressed on each other: the points of the smaller surface.
  void prepare(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k);
  // Before Proximity::find replaces the last step's contacts.
  void remember(const std::vector<ContactPoint>& contacts);
  // After it: replaces the contacts between these two bodies, i < k, of which one is split tissue.
  void place(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k, double T,
             std::vector<ContactPoint>& contacts);

 private:
  struct Surface {
    double area = 0.0;  // [m2]
    std::vector<PointLevel> levels;
    // Of split tissue of this Poisson's ratio: the loads of a level's points, as far as they have been near a contact.
    double poisson = -1.0;  // [1]
    std::vector<std::vector<std::shared_ptr<const SmearedLoad>>> loads;
  };
  struct Pressed;
  Surface& surface_of(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t body);
  std::uint32_t pressing(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k);
  std::size_t press(const Pressed& pair, std::size_t level, std::vector<ContactPoint>& out);

  ContactMemory last_;
  std::vector<ContactPoint> points_;  // of the last step
  std::vector<Surface> surfaces_;     // per body
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> level_;
};

}  // namespace pliant
