// From bodies and contacts to the contact problem and back (methods.md 2.5):
//   W = sum over bodies J A^-1 J^T + compliance,  bias = J v* + g0/T,  v = v* + A^-1 J^T lambda.
// Bodies are black boxes. W needs their contacts' mutual response; the velocity update needs one solution, for J^T
// lambda.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {

class Joints;

// Mutual response of one body's contacts.
struct BodyResponse {
  std::vector<int> contacts;  // its contacts, ascending
  Compliance compliance;      // J A^-1 J^T: three rows each, in the order of `contacts`
};

// Kept from step to step to reuse its memory. Valid from build_problem to the bodies' next free_step.
struct Delassus {
  std::vector<BodyResponse> of;  // per body
  Eigen::MatrixXd compliance;    // of yielding bodies, three rows per contact; empty without any
};

// After every body's free_step. Uncoupled contacts become parts of the problem (contact_islands.h). Penetrations are
// corrected by the share `beta` [1] per step (0.1-0.2), so that the added energy is negligible. The gap of a yielding
// body belongs to its law and is used in full. Initial impulses, sliding flags and friction are taken from the
// contacts.
void build_problem(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   double T, double beta, Delassus& delassus, ContactProblem& problem);

// Corrects every movable body by impulses [N s], three per contact along its axes.
void apply_impulses(const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
                    const std::vector<ContactPoint>& contacts, const Vector& impulses);
// Stores impulse and `sliding` in the contacts.
void keep_impulses(const ContactProblem& problem, std::vector<ContactPoint>& contacts);

// solve(), and both of the above. Contacts that only the solution produces (Proximity::find_missed) join and all are
// solved again, in a bounded number of rounds. Crossings that remain after the last one, also for lack of room
// (contact_budget.h), are `left`. Then once more, with the contacts updated to the end of the step by the solution
// (Proximity::look_again); before, they were extrapolated from the last step. In the level `hand` this reduces the
// error of the 1 kHz force by a third; another repetition changes little. Later sweeps are warm-started; a contact
// without prediction keeps its law. `joints`: those among the contacts break beyond their strength
// (Joints::snap), or are corrected to the step's end (Joints::look_again). `wedged`: penetrations that cannot be undone
// are left.
SweepReport solve_and_apply(const std::vector<std::unique_ptr<Body>>& bodies, Proximity& proximity, double T,
                            double beta, const SweepLimits& limits, Delassus& delassus,
                            std::vector<ContactPoint>& contacts, ContactProblem& problem, Crossings* left = nullptr,
                            Joints* joints = nullptr, bool wedged = false);

}  // namespace pliant
