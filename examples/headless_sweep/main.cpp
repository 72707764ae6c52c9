// Prints force against depth of a level's surfaces for several stiffnesses, without a window, as a table for plotting.
// Usage: headless_sweep LEVEL.gltf [PROBE]
#include <pliant/content.h>
#include <pliant/pliant.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s LEVEL.gltf [PROBE]\n", argv[0]), 2;
  std::vector<std::string> notes;
  auto scene = pliant::load_scene(argv[1], &notes);
  if (!scene) return std::fprintf(stderr, "%s\n", pliant::printable(scene.error().message()).c_str()), 1;
  for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", pliant::printable(note).c_str());
  const std::string probe = argc > 2 ? argv[2] : "sweep";
  if (argc <= 2) scene->add_probe(probe);
  auto session = pliant::Session::open(*scene);
  if (!session) return std::fprintf(stderr, "%s\n", session.error().message().c_str()), 1;

  std::printf("stiffness_N_m,time_s,depth_m,force_N\n");
  for (const double stiffness : {100.0, 300.0, 900.0}) {
    for (const std::string& object : session->objects())
      if (auto set = session->set(object, "stiffness", stiffness); !set)
        std::fprintf(stderr, "note: %s\n", set.error().message().c_str());
    if (auto orbit = session->orbit(probe); !orbit)
      return std::fprintf(stderr, "%s\n", orbit.error().message().c_str()), 1;
    for (int i = 0; i < 300; ++i) {
      if (auto stepped = session->step(10); !stepped)
        return std::fprintf(stderr, "%s\n", stepped.error().message().c_str()), 1;
      const auto felt = session->reading(probe);
      if (felt->touching)
        std::printf("%g,%.3f,%.6f,%.4f\n", stiffness, felt->time, felt->depth, pliant::length(felt->force));
    }
    if (auto released = session->release(probe); !released) return 1;
    if (auto restarted = session->restart(); !restarted) return 1;
  }
}
