// From bodies and contacts to the contact problem and back (methods.md 2.5):
//   W = sum over bodies J A^-1 J^T + compliance,  bias = J v* + g0/T,  v = v* + A^-1 J^T lambda.
// Bodies are black boxes: W asks them how their contacts move each other, v* + ... for one solution, of J^T lambda.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {

// How one body's contacts move each other.
struct BodyResponse {
  std::vector<int> contacts;  // those it takes part in, ascending
  Compliance compliance;      // J A^-1 J^T: three rows each, in the order of `contacts`
};

// Kept from step to step for its memory. Valid from build_problem to the bodies' next free_step.
struct Delassus {
  std::vector<BodyResponse> of;  // per body
  Eigen::MatrixXd compliance;    // of yielding bodies, three rows a contact; empty: there are none
};

// After every body's free_step. Contacts that do not move each other become parts of the problem (contact_islands.h).
// Penetrations are worked off by the share `beta` [1] a step (0.1-0.2), so that they add
// no energy worth the name; what a yielding body gives is its own law and is asked for whole. Warm impulses, sliding
// flags and friction come from the contacts.
void build_problem(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   double T, double beta, Delassus& delassus, ContactProblem& problem);

// Corrects every body that can move by what impulses [N s] do, three a contact along its axes.
void apply_impulses(const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
                    const std::vector<ContactPoint>& contacts, const Vector& impulses);
// Impulse and `sliding`, into the contacts.
void keep_impulses(const ContactProblem& problem, std::vector<ContactPoint>& contacts);

// solve(), and both of the above. Contacts that only the solution brings about (Proximity::find_missed) join and all
// are solved anew, in a bounded number of rounds; what still crosses after the last one, also for want of room
// (contact_budget.h), is `left`. Then once more: now the contacts lie where the step will end by the solution
// (Proximity::look_again); until then they were where the last step's motion led. In the level `hand` that takes a
// third off the error of the 1 kHz force, doing so once more changes little. Later sweeps start from the impulses that
// there are; of a contact that is not predicted the law stays what it was.
SweepReport solve_and_apply(const std::vector<std::unique_ptr<Body>>& bodies, Proximity& proximity, double T,
                            double beta, const SweepLimits& limits, Delassus& delassus,
                            std::vector<ContactPoint>& contacts, ContactProblem& problem, Crossings* left = nullptr);

}  // namespace pliant
