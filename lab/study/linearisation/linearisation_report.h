// Text that the study of linearisation writes about its figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/study/linearisation/study_linearisation.h"
#include "lab/study/pareto.h"

namespace pliant {

nlohmann::ordered_json linearisation_json(const LinearisationFigures& figures);
std::string linearisation_csv(const LinearisationFigures& figures);
void print_linearisation(const LinearisationFigures& figures);
// Of runs at several paces, the fastest first.
ParetoTable linearisation_table(const std::vector<LinearisationFigures>& all);

}  // namespace pliant
