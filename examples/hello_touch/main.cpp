// Presses a probe into a flat piece of tissue and prints the force on the hand.
#include <pliant/pliant.h>

#include <cstdio>

// 10 cm x 10 cm, in cells of 2 mm, facing up.
pliant::MeshData sheet() {
  constexpr std::uint32_t kCells = 50;
  pliant::MeshData mesh;
  for (std::uint32_t z = 0; z <= kCells; ++z)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      mesh.position.push_back({0.002f * float(x) - 0.05f, 0.0f, 0.002f * float(z) - 0.05f});
  for (std::uint32_t z = 0; z < kCells; ++z)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t i = z * (kCells + 1) + x, j = i + kCells + 1;
      for (const std::uint32_t corner : {i, j, i + 1, i + 1, j, j + 1}) mesh.index.push_back(corner);
    }
  return mesh;
}

int main() {
  pliant::Scene scene;
  scene.add_surface("tissue", sheet(), {.stiffness = 300.0});  // [N/m]
  scene.add_probe("finger");
  auto session = pliant::Session::open(scene);
  if (!session) return std::fprintf(stderr, "%s\n", session.error().message().c_str()), 1;

  for (int i = 0; i <= 1000; ++i) {  // one second: from 1 mm above to 4 mm below
    const double y = 0.001 - 5e-6 * i;
    if (auto moved = session->move("finger", {0, y, 0}); !moved) return 1;
    if (auto stepped = session->step(); !stepped) return 1;  // 1 ms
    if (i % 100 == 0) std::printf("y %6.2f mm  force %.3f N\n", 1e3 * y, session->reading("finger")->force.y);
  }
}
