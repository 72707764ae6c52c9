// Numbers from and to Python: vectors, poses, arrays. A value that cannot be one is an ArgumentError that names it.
#pragma once

#include <pliant/math.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace pliant_python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// An array of numbers; ArgumentError: `what`. Takes lists, tuples and arrays of any number type.
Doubles doubles(const py::handle& value, const std::string& what);
std::vector<double> numbers(const py::handle& value, const std::string& what);

pliant::dvec3 to_vec3(const py::handle& value, const std::string& what);
pliant::dquat to_quat(const py::handle& value, const std::string& what);  // (w, x, y, z)

// A pose: three numbers, or seven with the rotation (w, x, y, z).
struct Pose {
  pliant::dvec3 position{0};
  pliant::dquat rotation{1, 0, 0, 0};
};
Pose to_pose(const py::handle& value, const std::string& what);
// False: Session::move may refuse it.
bool is_sound(const Pose& pose);

py::array_t<double> array_of(pliant::dvec3 v);
py::array_t<double> array_of(pliant::dquat q);  // (w, x, y, z)
py::array_t<double> array_of(const pliant::mat4& m);
template <class T, int N, class From>
py::array_t<T> rows_of(const std::vector<From>& from) {
  py::array_t<T> out({static_cast<py::ssize_t>(from.size()), py::ssize_t{N}});
  T* to = out.mutable_data();
  for (const From& row : from)
    for (int k = 0; k < N; ++k) *to++ = row[k];
  return out;
}
py::array_t<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& index);

std::string number_text(double value);
std::string vector_text(pliant::dvec3 v);

}  // namespace pliant_python
