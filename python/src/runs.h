// A path in C++: a tick per row, and what each tick gave. The same calls as a loop over Session.tick.
#pragma once

#include <pliant/session.h>
#include <pybind11/pybind11.h>

#include "python/src/held_session.h"
#include "python/src/values.h"

namespace pliant_python {

void bind_runs(py::module_& module);

// The readings of one effector, a row a tick.
class Felt {
 public:
  Felt(std::size_t ticks, bool tool);
  void keep(std::size_t row, const pliant::Reading& reading);  // without the GIL
  py::dict arrays() const;

 private:
  py::array_t<double> force_, torque_, position_, normal_, depth_;
  py::array_t<bool> touching_;
  py::array_t<std::int32_t> object_;
  double *force_at_, *torque_at_ = nullptr, *position_at_, *normal_at_, *depth_at_;
  bool* touching_at_;
  std::int32_t* object_at_;
};

// Poses of one effector, a row a tick.
struct Track {
  std::string effector;
  Doubles rows;  // (n, 3) or (n, 7)
  const double* at = nullptr;
  std::size_t columns = 3;
};

}  // namespace pliant_python
