// Scenes in code and from files.
#pragma once

#include <pliant/scene.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <utility>

#include "python/src/failure.h"

namespace pliant_python {

// A Scene in Python.
struct HeldScene : pliant::Scene {
  using pliant::Scene::Scene;
  explicit HeldScene(pliant::Scene scene) : pliant::Scene(std::move(scene)) {}
  // pybind11 allocates what `Scene.__new__` left without __init__ by this.
  static void* operator new(std::size_t) { not_initialised("Scene"); }
  static void operator delete(void*) {}
};

void bind_scenes(py::module_& module);

}  // namespace pliant_python
