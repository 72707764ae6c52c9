// The tool itself at the end of a finished step. Takes the tool and its contacts' forces; gives the handle's motion and
// mass, the wrench on it, and the tissue that follows it: how heavy, damped and stiff it is to the handle.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// After describe_contacts. Fills handle, centre, soft_step, handle_mass, handle_load and force, and tissue_mass,
// tissue_damping, tissue_stiffness and tissue_force of the contacts.
void describe_handle_and_tissue(const ToolContacts& contacts, HandleModel& out);

}  // namespace pliant
