// A tick of the handle at 1 kHz (methods.md 2.7, 2.8), on plain numbers: tissue and contacts are in the model, device
// and handle in TickHandle. Nothing here allocates.
#pragma once

#include "systems/soft/contact/contact_problem.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// The handle's equation without the model: (inertia) w = right + the model's terms. Or a handle with prescribed motion.
struct TickHandle {
  Matrix6 inertia = Matrix6::Zero();   // [kg ...] M_h + tick B_c + tick^2 K_c
  Vector6 right = Vector6::Zero();     // [N s ...] M_h w + coupling's
  Vector6 velocity = Vector6::Zero();  // w: in: at the beginning of the tick; out: at its end
  bool moved = false;                  // prescribed: `next` is w at the end, independent of forces
  Vector6 next = Vector6::Zero();
};

// d: displacement of the handle since the model's pose. Both return the wrench on the handle over the tick, including
// the tissue's inertia. [N], [N m]
Vector6 linear_tick(const LinearModel& model, const Vector6& w0, const Vector6& d, double tick, TickHandle& handle);

// State of a CondensedContacts as ticks advance it. Sized once.
struct CondensedState {
  Vector q, rate;             // modes
  Vector spring;              // [m] 3 count: stretch of `flexibility`
  Vector gap;                 // [m] count
  std::vector<double> reach;  // [m] count: slip beyond which an open contact no longer exists
  std::vector<dvec2> slip;    // [m] count: along the contacts' tangents, since the axes were set
  std::vector<dvec3> shift;   // [m/s] count: change of the contacts' velocities by their slip
  Vector6 d = Vector6::Zero();
  ContactProblem problem;          // its impulse and sliding flags are the warm start
  std::vector<std::uint64_t> key;  // of the contacts of the last solve
  double tick = 0.0;               // [s] length of that tick
  Vector last;                     // [N s] working memory: impulses of those contacts
  SweepReport report;
  Vector free_rate, moved;  // working memory
  Lever lever;

  void resize(int most_contacts, int most_modes);
  // Starts from the model's state. The model lacks the forces of stiff contacts (reduce/stiff_contacts.h): they
  // continue from the previous model, or the first tick would have to find a whole stack's forces from zero.
  void start(const CondensedContacts& model);
};

Vector6 condensed_tick(const CondensedContacts& model, CondensedState& state, const SweepLimits& limits,
                       TickHandle& handle);

}  // namespace pliant
