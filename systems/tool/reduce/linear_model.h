// The wrench on the handle as a linear function of its motion: the set of touching contacts stays as the step left it
// (methods.md 2.6). Takes the condensed contacts, their Delassus operator and what the tool's tissue does by itself;
// gives mass, damping, stiffness and force.
#pragma once

#include "systems/soft/body/tool_body.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// `model`: everything but `linear` is filled. `W` [1/kg]: of its contacts, the handle held (condense_bodies).
LinearModel linear_model(const ToolBody& tool, const HandleModel& model, const Eigen::MatrixXd& W);

}  // namespace pliant
