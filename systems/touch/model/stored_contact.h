// The energy that one contact stores as if it were alone.
#pragma once

#include "systems/touch/collide/contact_search.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/pressing.h"

namespace pliant {

// y: free recovery of the surface towards rest.
void advance_free_surface(Contact& contact, const FootBlend& place, const Mesh& mesh, const Motion& motion);

// Its energy and the gradient of that. False: too shallow to store any.
bool store(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& out);

}  // namespace pliant
