// From where the soft step has left the handle to where the touch clock has it. The hand's impedance lets the step's
// handle fall a little short of its lead (tool_body.h); the model must stand where the touch clock's handle stands. So
// the step is taken again in reduced form, its handle going the whole way: contacts are solved anew with the handle
// held on it, and tissue, modes and objects follow.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// `left` [m], [rad]: the handle's way from the step's end to its lead. `W` [1/kg]: of the contacts, the handle held
// (condense_bodies). After everything that describes the step, before ticks are prepared. Contacts marked stiff stay as
// they are: they do not give way to a lead.
void catch_up(const ToolContacts& contacts, const Vector6& left, const Eigen::MatrixXd& W, HandleModel& model);

}  // namespace pliant
