// The wrench on the handle as a linear function of its motion, with the set of touching contacts frozen at the step's
// end (methods.md 2.6). Input: the condensed contacts, their Delassus operator and the tissue's response. Output: mass,
// damping, stiffness and force.
#pragma once

#include "systems/soft/body/tool_body.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// `model`: all but `linear` is filled. `W` [1/kg]: of its contacts, the handle fixed (condense_bodies).
LinearModel linear_model(const ToolBody& tool, const HandleModel& model, const Eigen::MatrixXd& W);

}  // namespace pliant
