// Which contacts move each other. Contacts on one body that moves, or that yields, are joined; a fixed body joins
// nothing. What is not joined is solved apart: its own residual, its own stop, and W grows with the contacts of an
// island, not of the level.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {

// Fills problem.part_count, place and each part's members and size; one island: no parts. Islands are numbered by their
// first contact, and contacts keep their order in them.
void split_contacts(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                    ContactProblem& problem);

}  // namespace pliant
