// A P1 surface (Deformable) among the bodies of the soft step: where the two models touch. It has no degrees of freedom
// - its surface has no inertia that a hand could feel - but it gives way by P1's own law: contacts j dent it by
// amplitudes alpha_j, which add up at contact i to the depth
//   d = A alpha,   A_ij = f(|c_i - c_j|) of the object's shape function (as systems/touch/force_field.cpp has it),
// and each pushes back with F_i = k_i alpha_i + c d_i' (k the law's secant at the depth so far, painted factor
// included; c contact_damping). One contact is then P1's probe, F = law(d) + c d'; many that stand together share one
// dent instead of adding up their forces, so that the force does not depend on how finely the tissue is meshed.
// The step's law, implicit over T, with lambda = T F and C = K^(-1/2) A K^(-1/2) [m/N]:
//   d1 = M (lambda + c d0),   M = (T + c C)^-1 C,   so  u_n >= 0 becomes  J v + (g0 + M c d0) / T + (M / T) lambda >=
//   0.
// C is cut to its positive part: a shape with a rim is not positive definite for every layout of contacts.
// The slow arm of the standard linear solid is left out: tissue feels the lasting stiffness.
// Writer: the soft clock.
#pragma once

#include <vector>

#include "components/transform.h"
#include "components/world.h"
#include "systems/soft/body/immovable_body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/touch/press.h"

namespace pliant {

class YieldingBody final : public ImmovableBody {
 public:
  bool is_surface() const override { return true; }
  // `slot`: its place in TouchState::objects. `mesh` outlives it.
  YieldingBody(const Mesh& mesh, const Deformable& deformable, const Pose& pose, std::size_t slot);

  void set(const DeformableParameters& now);

  // Puts its contacts where P1's collision would find the tissue's points: foot, interpolated normal and height over
  // the rest surface; drops those beside an open surface's rim. `self`: its place among the bodies. Prepares the law
  // for a step of T [s]. Call on the contacts of a step, before the problem is built from them.
  void place(std::vector<ContactPoint>& contacts, std::uint32_t self, double T);
  // Takes the solved impulses: from now on the surface is dented so.
  void yield(const std::vector<ContactPoint>& contacts, double T);
  // The deepest points that press, well apart, for the touch clock; call after the bodies advanced by T.
  void list_presses(const std::vector<ContactPoint>& contacts, const std::vector<std::unique_ptr<Body>>& bodies,
                    double T, ObjectPresses& out) const;
  std::size_t slot() const { return slot_; }

  void free_step(double, dvec3) override {}  // a surface without inertia has no motion of its own
  void advance(double) override {}
  bool yields() const override { return true; }
  void add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const override;
  void show(SoftObjectSnapshot&) const override {}

 private:
  // One of its contacts in this step.
  struct Dent {
    std::uint32_t contact = 0;   // into the contacts
    bool is_a = false;           // which side of it this body is
    std::uint32_t triangle = 0;  // under it
    dvec3 barycentric{1, 0, 0};  // [1]
    FieldSource source;          // amplitude 1 until the step is solved
    double stiffness = 0.0;      // [N/m] k
    double depth = 0.0;          // [m] d0 >= 0
  };
  bool place(ContactPoint& contact, bool is_a, Dent& dent) const;
  Eigen::MatrixXd shares() const;  // A
  void dent_surface();
  PressPoint press_point(const Dent& dent, const std::vector<ContactPoint>& contacts,
                         const std::vector<std::unique_ptr<Body>>& bodies, double T) const;

  Deformable deformable_;
  Pose pose_;
  std::size_t slot_;
  double damping_ = 0.0;  // [N s/m] c
  std::vector<Dent> dents_;
  Eigen::MatrixXd mobility_;           // M [m/(N s)]
  std::vector<std::uint32_t> dented_;  // zones whose collision mesh is not at rest
};

}  // namespace pliant
