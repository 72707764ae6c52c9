// A P1 surface (Deformable) among the bodies of the soft step: the interface of the two models. It has no degrees of
// freedom, since its surface has no inertia that a hand could feel, but it yields by P1's law. Contacts j dent it by
// amplitudes alpha_j, which add up at contact i to the depth
//   d = A alpha,   A_ij = f(|c_i - c_j|) of the object's shape function (as in systems/touch/model/force_field.cpp),
// and each pushes back with F_i = k_i alpha_i + c d_i' (k: the law's secant at the current depth, painted factor
// included; c: contact_damping). A single contact is then P1's probe, F = law(d) + c d'. Many adjacent contacts share
// one dent instead of adding up their forces, so that the force does not depend on the tissue's mesh. The step's law,
// implicit over T, with lambda = T F and C = K^(-1/2) A K^(-1/2) [m/N]:
//   d1 = M (lambda + c d0),   M = (T + c C)^-1 C,
//   so  u_n >= 0 becomes  J v + (g0 + M c d0) / T + (M / T) lambda >= 0.
// C is projected to its positive part: a shape with a rim is not positive definite for every arrangement of contacts.
// d0 is the surface's depth at a contact after the last step: below a contact that does not press it is deeper than
// the tissue. So the depth at rest, C F, depends neither on c nor on T.
// The slow arm of the standard linear solid is left out: tissue feels the long-term stiffness.
// Writer: the soft clock.
#pragma once

#include <vector>

#include "components/transform.h"
#include "components/varying.h"
#include "components/world.h"
#include "systems/soft/body/immovable_body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/touch/feed/press.h"

namespace pliant {

class YieldingBody final : public ImmovableBody {
 public:
  bool is_surface() const override { return true; }
  // `slot`: its index in TouchState::objects. `mesh` outlives it.
  YieldingBody(const Mesh& mesh, const Deformable& deformable, const Pose& pose, std::size_t slot);

  void set(const DeformableParameters& now);
  void vary(const Varying& varying, double time);

  // Moves its contacts to the tissue's points as found by P1's collision: foot, interpolated normal and height over the
  // rest surface. Drops contacts beside an open surface's rim. `self`: its index among the bodies. Prepares the law for
  // a step of T [s]. Call on the contacts of a step, before the problem is built from them.
  void place(std::vector<ContactPoint>& contacts, std::uint32_t self, double T);
  // Takes the solved impulses and dents the surface accordingly.
  void yield(const std::vector<ContactPoint>& contacts, double T);
  // The deepest pressing points, well separated, for the touch clock; call after the bodies advanced by T.
  void list_presses(const std::vector<ContactPoint>& contacts, const std::vector<std::unique_ptr<Body>>& bodies,
                    double T, ObjectPresses& out) const;
  std::size_t slot() const { return slot_; }

  void free_step(double, dvec3) override {}  // a surface without inertia has no free motion
  void advance(double) override {}
  bool yields() const override { return true; }
  void add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const override;
  void show(SoftObjectSnapshot&) const override {}

 private:
  // One of its contacts in this step.
  struct Dent {
    std::uint32_t contact = 0;   // into the contacts
    bool is_a = false;           // the side of the contact that this body is
    std::uint32_t triangle = 0;  // under it
    dvec3 barycentric{1, 0, 0};  // [1]
    FieldSource source;          // amplitude 1 until the step is solved
    std::uint64_t key = 0;       // ContactPoint::key
    double stiffness = 0.0;      // [N/m] k
    double depth = 0.0;          // [m] >= 0, of the tissue; of the surface once the step is solved
    double before = 0.0;         // [m] d0 >= 0
  };
  bool place(ContactPoint& contact, bool is_a, Dent& dent) const;
  double depth_before(const Dent& dent) const;
  Eigen::MatrixXd shares() const;  // A
  void dent_surface();
  PressPoint press_point(const Dent& dent, const std::vector<ContactPoint>& contacts,
                         const std::vector<std::unique_ptr<Body>>& bodies, double T) const;

  Deformable deformable_;
  Pose pose_;
  std::size_t slot_;
  double damping_ = 0.0;               // [N s/m] c
  std::vector<Dent> dents_, last_;     // of this step, and of the one before
  Eigen::MatrixXd mobility_;           // M [m/(N s)]
  std::vector<std::uint32_t> dented_;  // zones of the collision mesh that are not at rest
};

}  // namespace pliant
