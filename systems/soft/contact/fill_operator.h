// Assembles W of all islands from the bodies' responses (delassus.h): dense, or by columns where most blocks are zero.
#pragma once

#include "systems/soft/contact/delassus.h"

namespace pliant {

// problem.W [1/kg] or problem.sparse, of each part; split_contacts (contact_islands.h) comes before.
void fill_operator(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   const Delassus& delassus, ContactProblem& problem);

}  // namespace pliant
