// A tick of the handle at 1 kHz (methods.md 2.7, 2.8), on plain numbers: everything about tissue and contacts is in the
// model, everything about device and handle in TickHandle. Nothing here allocates.
#pragma once

#include "systems/soft/contact/contact_problem.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// What else the handle obeys: (inertia) w = right + what the model adds. Or a handle that is moved as it is told.
struct TickHandle {
  Matrix6 inertia = Matrix6::Zero();   // [kg ...] M_h + tick B_c + tick^2 K_c
  Vector6 right = Vector6::Zero();     // [N s ...] M_h w + coupling's
  Vector6 velocity = Vector6::Zero();  // w: in: at the beginning of the tick; out: at its end
  bool moved = false;                  // `next` is w at the end, whatever the forces
  Vector6 next = Vector6::Zero();
};

// d: displacement of the handle since the model's pose. Both return the wrench on the handle over the tick, inertia of
// the tissue included. [N], [N m]
Vector6 linear_tick(const LinearModel& model, const Vector6& w0, const Vector6& d, double tick, TickHandle& handle);

// What a CondensedContacts has become since its time. Sized once.
struct CondensedState {
  Vector q, rate;             // modes
  Vector spring;              // [m] 3 count: stretch of `flexibility`
  Vector gap;                 // [m] count
  std::vector<double> reach;  // [m] count: slip beyond which an open contact is gone
  std::vector<dvec2> slip;    // [m] count: along the contacts' tangents, since their axes were laid
  std::vector<dvec3> shift;   // [m/s] count: of the contacts' velocities, since where they touch has slipped on
  Vector6 d = Vector6::Zero();
  ContactProblem problem;          // its impulse and sliding flags are the warm start
  std::vector<std::uint64_t> key;  // of the contacts that `problem` was last solved with
  double tick = 0.0;               // [s] and how long that tick was
  Vector last;                     // [N s] working memory: their impulses
  SweepReport report;
  Vector free_rate;  // working memory
  Eigen::Matrix<double, Eigen::Dynamic, 6> lever;

  void resize(int most_contacts, int most_modes);
  // Where the model stands. What its stiff contacts push with it does not know (reduce/stiff_contacts.h): they go on
  // from what they did in the model before, or the first tick would have to find a whole tower's forces from nothing.
  void start(const CondensedContacts& model);
};

Vector6 condensed_tick(const CondensedContacts& model, CondensedState& state, const SweepLimits& limits,
                       TickHandle& handle);

}  // namespace pliant
