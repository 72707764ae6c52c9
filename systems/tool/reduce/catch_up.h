// Moves the model from the soft step's handle to the touch clock's. Because of the hand's impedance, the step's handle
// stops a little short of its prescribed pose (tool_body.h), but the model must be at the touch clock's handle. The
// step is therefore repeated in reduced form with the handle moving the whole distance. Contacts are solved again with
// that handle prescribed; tissue, modes and objects follow.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

// `left` [m], [rad]: the handle's displacement from the step's end to its prescribed pose. `W` [1/kg]: of the contacts,
// the handle fixed (condense_bodies). Called after the step is fully described, before ticks are prepared. Stiff
// contacts are unchanged: they do not yield to a prescribed motion.
//
// By `left` the hand's impedance pushed bodies otherwise than the touch clock's handle was pushed back. Where tissue
// resists, the new force makes up for it. Bodies that move freely have that momentum, so the handle is owed it
// (HandleModel::owed): the sums of both impulses are equal. Returns what the wrench on the handle would have
// more if bodies that move freely kept their inertia: for the linear model, whose bodies have no motion of their own.
Vector6 catch_up(const ToolContacts& contacts, const Vector6& left, const Eigen::MatrixXd& W, HandleModel& model);

}  // namespace pliant
