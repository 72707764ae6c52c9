// Tissue bodies of an object for the presses of a fit: each place gets a lattice that is fine under the punch and
// coarse far away. A uniform lattice would need cells of half the punch's radius everywhere.
//
// The discretisation error has order two (measured 1.8 to 1.9 against the closed form of a bonded layer). Two lattices
// at the same places therefore give the limit of vanishing cell size. The ratio is nearly the same at every place.
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
  // Makes the node a tissue (its own keys, overridden by the options) for presses of a punch. Errors: no modulus given,
  // the mesh cannot be filled, nothing is pinned.
  static Result<PressBodies> make(const Level& level, std::int32_t number, const FitOptions& options);

  // The surface that is pressed: curved patches, refined for dents. Without the inner sheet of a filled wall.
  const Mesh& surface() const { return surface_->mesh; }
  const Mesh& object() const { return object_->mesh; }  // the whole object
  const SoftBody& body() const { return *node_.soft_body; }
  double radius() const { return radius_; }  // [m] of the punch
  double cell() const { return cell_; }      // [m] under the punch
  const std::string& why() const { return why_; }
  // Per vertex of a mesh of the object: true if no vertex of the same side within this distance [m] is pinned, and it
  // is on no inner sheet.
  std::vector<std::uint8_t> is_free(const Mesh& mesh, double within) const;
  // True if one body serves all places: for tetrahedra from a file, and for walls, whose lattice may not be coarse
  // anywhere.
  bool is_one() const { return one_ != nullptr; }

  // The body to press at this place, with cells of `share` [1] times cell(). If is_one(), use it from one thread at a
  // time; it serves deep presses too.
  Result<std::shared_ptr<TissuePress>> at(const PressPlace& place, PressKind kind, double share = 1.0) const;

 private:
  PressBodies() = default;
  Status leave_out_inner(std::vector<Primitive> primitives, const mat4& to_object, const MeshOptions& options);
  LevelNode node_;
  TissueMaterial material_;
  std::shared_ptr<const BuiltMesh> surface_, object_;
  std::shared_ptr<TissuePress> one_;
  double radius_ = 0.0, cell_ = 0.0;
  std::string why_;  // reason for the choice of radius
};

}  // namespace pliant
