// The contacts that a step has found between collision meshes, before and after thinning.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/collide/collision_mesh.h"
#include "systems/soft/collide/contact_geometry.h"
#include "systems/soft/collide/contact_thinning.h"
#include "systems/soft/collide/meeting_filter.h"
#include "systems/soft/contact/contact_point.h"

namespace pliant {

struct FoundContacts {
  std::vector<CollisionMesh> collision_meshes;
  std::vector<double> mean_edge;  // [m] per body
  std::vector<Found> found;
  std::vector<Candidate> candidates, thinned;  // those to keep; all before thinning

  // Makes candidates of the contacts appended to `found` from `first` on; contacts with NaN are dropped (a body has
  // diverged). Returns the deepest penetration [m] >= 0; with `late`, also at the end of the step.
  double keep(std::size_t first, bool late);
  // After thinning: a contact that joined in an earlier step stays while it carries load: the same contacts,
  // warm-started, step after step.
  void keep_joined();

  std::pair<SurfacePoint, SurfacePoint> points_of(const Found& f) const;
  FeaturePair pair_of(const Found& f) const;
  // [m] Gap at the end of the step, by the contact's normal and the displacements of the collision meshes' sweep.
  double end_gap(const Found& f) const;
  ContactPoint contact_of(const std::vector<std::unique_ptr<Body>>& bodies, const Candidate& candidate,
                          bool late) const;

 private:
  double edge_there(const Found& f) const;
};

}  // namespace pliant
