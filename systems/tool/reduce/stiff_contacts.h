// Contacts that tissue and objects cannot give way to: a rigid part of the tool on a fixed body, a rigid object between
// the two, very hard tissue. While the soft step leads the handle, the force of such a contact is what the lead's
// inertia makes of it, thousands of newtons; no hand gives that. It is left to the touch tick, where the handle has its
// own inertia and is held by its device.
#pragma once

#include "systems/tool/handle_model.h"

namespace pliant {

// [1/kg] The lead's compliance is a tenth of it. Larger: softer contacts lose their force at every model's coming.
inline constexpr double kRigidCompliance = 1e-3;

// Marks the contacts through which a push of the handle meets what cannot give way. `W` [1/kg]: of the contacts, the
// handle held (condense_bodies). Fills `stiff`; after from_handle.
void mark_stiff(const Eigen::MatrixXd& W, CondensedContacts& out);

// Takes the forces of the marked contacts out of the model. What they have held back is left as penetration: what gave
// way to them, and the way `left` [m], [rad] that the handle would still have to go to where the touch clock has it.
// The share `beta` [1] of it is undone in a soft step of T [s]. Returns their wrench on the handle. [N], [N m]
Vector6 drop_stiff(double T, double beta, const Vector6& left, CondensedContacts& contacts);

}  // namespace pliant
