// An object as tissue, made anew for each place that is pressed: a lattice that is fine under the punch and coarse far
// away. A lattice that is even all over would need cells of half the punch's radius everywhere.
//
// Error of the elements: their order is two (measured 1.8 to 1.9 against the closed form of a bonded layer), so that
// two lattices at the same places tell what one without size would give; the ratio is nearly the same at every place.
#pragma once

#include <memory>
#include <string>

#include "content/level/level.h"
#include "content/mesh/mesh_build.h"
#include "lab/fit/fit.h"
#include "lab/fit/tissue_press.h"

namespace pliant {

class PressBodies {
 public:
  // The node as tissue (its own keys, what the options say instead), for presses of a punch. Errors: it says no
  // modulus, cannot be filled, is held nowhere.
  static Result<PressBodies> make(const Level& level, std::int32_t number, const FitOptions& options);

  // What is pressed: curved where the object is, fine enough for dents. Without the inner sheet of a wall that is
  // filled.
  const Mesh& surface() const { return surface_->mesh; }
  const Mesh& object() const { return object_->mesh; }  // all of it
  const SoftBody& body() const { return *node_.soft_body; }
  double radius() const { return radius_; }  // [m] of the punch
  double cell() const { return cell_; }      // [m] under the punch
  const std::string& why() const { return why_; }
  // Of each vertex of a mesh of the object: whether nothing of the same side of it is held within this distance [m],
  // and it is of no inner sheet.
  std::vector<std::uint8_t> is_free(const Mesh& mesh, double within) const;
  // Tetrahedra from a file, and walls, whose lattice may not be coarse anywhere, are one body for all places.
  bool is_one() const { return one_ != nullptr; }

  // The body to press at this place, its cells this share [1] of cell(). One at a time where is_one(); that one is for
  // deep presses too.
  Result<std::shared_ptr<TissuePress>> at(const PressPlace& place, PressKind kind, double share = 1.0) const;

 private:
  PressBodies() = default;
  Status leave_out_inner(std::vector<Primitive> primitives, const mat4& to_object, const MeshOptions& options);
  LevelNode node_;
  TissueMaterial material_;
  std::shared_ptr<const BuiltMesh> surface_, object_;
  std::shared_ptr<TissuePress> one_;
  double radius_ = 0.0, cell_ = 0.0;
  std::string why_;  // the radius
};

}  // namespace pliant
