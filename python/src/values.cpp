#include "python/src/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "python/src/failure.h"

namespace pliant_python {
namespace {

std::string shape_of(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i ? ", " : "") + std::to_string(array.shape(i));
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

}  // namespace

Doubles doubles(const py::handle& value, const std::string& what) {
  const py::array any = py::array::ensure(value);
  if (!any) {
    PyErr_Clear();
    wrong_argument(what, "must be numbers", "give a list or an array");
  }
  const char kind = any.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b')
    wrong_argument(what, "must be numbers; got an array of " + std::string(py::str(any.dtype())),
                   "give a list or an array");
  return Doubles(any);
}

std::vector<double> numbers(const py::handle& value, const std::string& what) {
  const Doubles array = doubles(value, what);
  if (array.ndim() != 1) wrong_argument(what, "must be a row of numbers; its shape is " + shape_of(array), "");
  return {array.data(), array.data() + array.size()};
}

pliant::dvec3 to_vec3(const py::handle& value, const std::string& what) {
  const Doubles v = doubles(value, what);
  if (v.ndim() != 1 || v.size() != 3)
    wrong_argument(what, "must be three numbers (x, y, z); its shape is " + shape_of(v), "");
  return {v.data()[0], v.data()[1], v.data()[2]};
}

pliant::dquat to_quat(const py::handle& value, const std::string& what) {
  const Doubles q = doubles(value, what);
  if (q.ndim() != 1 || q.size() != 4)
    wrong_argument(what, "must be four numbers (w, x, y, z); its shape is " + shape_of(q), "");
  return {q.data()[0], q.data()[1], q.data()[2], q.data()[3]};
}

bool is_sound(const Pose& pose) {
  return std::isfinite(dot(pose.position, pose.position)) && std::abs(dot(pose.rotation, pose.rotation) - 1.0) < 1e-6;
}

Pose to_pose(const py::handle& value, const std::string& what) {
  const Doubles p = doubles(value, what);
  if (p.ndim() != 1 || (p.size() != 3 && p.size() != 7))
    wrong_argument(what, "must be (x, y, z), or (x, y, z, qw, qx, qy, qz); its shape is " + shape_of(p), "");
  const double* v = p.data();
  Pose pose{{v[0], v[1], v[2]}, {1, 0, 0, 0}};
  if (p.size() == 7) pose.rotation = {v[3], v[4], v[5], v[6]};
  return pose;
}

py::array_t<double> array_of(pliant::dvec3 v) {
  py::array_t<double> out(3);
  for (int k = 0; k < 3; ++k) out.mutable_data()[k] = v[k];
  return out;
}

py::array_t<double> array_of(pliant::dquat q) {
  py::array_t<double> out(4);
  double* to = out.mutable_data();
  to[0] = q.w, to[1] = q.x, to[2] = q.y, to[3] = q.z;
  return out;
}

py::array_t<double> array_of(const pliant::mat4& m) {
  py::array_t<double> out({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) out.mutable_data()[4 * row + column] = m[column][row];
  return out;
}

py::array_t<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& index) {
  py::array_t<std::uint32_t> out({static_cast<py::ssize_t>(index.size() / 3), py::ssize_t{3}});
  std::copy(index.begin(), index.begin() + out.size(), out.mutable_data());
  return out;
}

std::string number_text(double value) {
  return fmt::format("{:.6g}", value);
}

std::string vector_text(pliant::dvec3 v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

}  // namespace pliant_python
