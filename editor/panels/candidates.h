// The models measured for an object (engine/choice), as a table and as a plot of error against cost.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/choice/model_choice.h"

namespace pliant {

class CandidateView {
 public:
  // At the cursor, with the available width and this height [pixel]. `faded`: the object has changed since the
  // measurement.
  void table(const ModelChoice& choice, float high, bool faded);
  void plot(const ModelChoice& choice, float wide, float high, bool faded);

 private:
  std::optional<std::size_t> pointed_;  // under the mouse in table or plot, in the last frame
  std::optional<std::size_t> points_;   // in this frame
  std::vector<std::size_t> order_;      // of the rows
};

}  // namespace pliant
