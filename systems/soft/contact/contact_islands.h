// Partition of contacts into coupled islands. Contacts on one movable or yielding body are coupled; a fixed body
// couples nothing. Islands are solved separately: each has its residual and stopping criterion, and W grows with the
// contacts of an island, not of the level.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {

// Fills problem.part_count, place and each part's members and size; a single island has no parts. Islands are numbered
// by their first contact; contacts keep their order in them.
void split_contacts(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                    ContactProblem& problem);

// Contacts of one pair of bodies, and which have slipped far enough to break loose by themselves.
void find_patches(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts, double T,
                  ContactProblem& problem);

}  // namespace pliant
