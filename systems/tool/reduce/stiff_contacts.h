// Contacts where neither tissue nor objects are compliant: a rigid part of the tool on a fixed body, a rigid object
// between the two, very hard tissue. While the soft step prescribes the handle's motion, the inertia of that motion
// determines the force of such a contact: thousands of newtons, more than any hand gives. It is left to the touch tick,
// where the handle has its physical inertia and is coupled to its device.
#pragma once

#include "systems/tool/handle_model.h"

namespace pliant {

// [1/kg] Ten times the compliance of the handle's prescribed motion. Larger: softer contacts lose their force at every
// new model.
inline constexpr double kRigidCompliance = 1e-3;

// Marks the contacts through which a push of the handle meets no compliance. `W` [1/kg]: of the contacts, the handle
// fixed (condense_bodies). Fills `stiff`; after from_handle.
void mark_stiff(const Eigen::MatrixXd& W, CondensedContacts& out);

// Removes the forces of the marked contacts from the model. The motion that they prevented becomes penetration: the
// elastic deformation under them, and the displacement `left` [m], [rad] from the handle to the touch clock's handle. A
// share `beta` [1] of it is corrected in a soft step of T [s]. Returns the removed wrench on the handle. [N], [N m]
Vector6 drop_stiff(double T, double beta, const Vector6& left, CondensedContacts& contacts);

}  // namespace pliant
