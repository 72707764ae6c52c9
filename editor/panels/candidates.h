// The models that were measured for an object (engine/choice), as a table and as error against cost.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/choice/model_choice.h"

namespace pliant {

class CandidateView {
 public:
  // At the cursor, as wide as there is room and so high [pixel]. `faded`: the figures are of another object than now.
  void table(const ModelChoice& choice, float high, bool faded);
  void plot(const ModelChoice& choice, float wide, float high, bool faded);

 private:
  std::optional<std::size_t> pointed_;  // under the mouse, in the table or the plot, in the frame before
  std::optional<std::size_t> points_;   // in this frame
  std::vector<std::size_t> order_;      // of the rows
};

}  // namespace pliant
