// The tool at the end of a finished step. Input: the tool and its contacts' forces. Output: the handle's motion and
// mass, the wrench on it, and the effective mass, damping and stiffness of the tissue that follows it.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// After describe_contacts. Fills handle, centre, soft_step, handle_mass, handle_load and force, and tissue_mass,
// tissue_damping, tissue_stiffness and tissue_force of the contacts.
void describe_handle_and_tissue(const ToolContacts& contacts, HandleModel& out);

}  // namespace pliant
