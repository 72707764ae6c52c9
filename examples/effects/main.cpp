// Effects by program: a magnet that only one of two probes feels, a wall, a rail without a file, and a skin that gets
// rough under the finger.
#include <pliant/pliant.h>

#include <algorithm>
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

int fail(const pliant::Error& error) {
  return std::fprintf(stderr, "%s\n", error.message().c_str()), 1;
}

int main() {
  pliant::Scene scene;
  scene.add_surface("skin", sheet(), {.stiffness = 300.0, .friction_static = 0.0, .friction_sliding = 0.0});
  scene.add_probe("finger");
  scene.add_probe("thumb");
  // 200 N/m within 20 mm, 60 mm above the skin: the finger alone feels it.
  scene.add_effect("magnet", {.kind = pliant::EffectKind::kAttraction, .stiffness = 200.0, .probes = {"finger"}},
                   {.position = {0, 0.06, 0}});
  // Nothing gets below y = -10 mm.
  scene.add_effect(
      "floor", {.kind = pliant::EffectKind::kForbidden, .region = pliant::EffectRegion::kHalfSpace, .stiffness = 500.0},
      {.position = {0, -0.01, 0}});
  pliant::Path rail;
  for (const double x : {-0.05, 0.05}) rail.rows.push_back({0.0, {x, 0, 0}});
  scene.add_effect("rail", {.kind = pliant::EffectKind::kGuidance, .stiffness = 100.0}, {.position = {0, 0.12, 0}},
                   rail);

  auto session = pliant::Session::open(scene);
  if (!session) return fail(session.error());
  for (const char* probe : {"finger", "thumb"})
    if (auto moved = session->move(probe, {0.005, 0.06, 0}); !moved) return fail(moved.error());
  if (auto stepped = session->step(600); !stepped) return fail(stepped.error());  // it fades in over 0.5 s
  std::printf("magnet: finger %.3f N, thumb %.3f N\n", session->reading("finger")->force.x,
              session->reading("thumb")->force.x);
  if (auto set = session->set("magnet", "stiffness", 400.0); !set) return fail(set.error());  // the next tick has it
  if (auto stepped = session->step(600); !stepped) return fail(stepped.error());
  std::printf("twice as stiff: finger %.3f N\n", session->reading("finger")->force.x);

  for (const double amplitude : {0.0, 1e-4}) {
    if (auto set = session->set("skin", "texture.amplitude", amplitude); !set) return fail(set.error());
    double low = 1e9, high = -1e9;
    for (int i = 0; i <= 600; ++i) {  // down to 2 mm, then 20 mm along
      const double y = std::max(-0.002, 0.002 - 1e-5 * i), x = std::max(0.0, 1e-4 * (i - 400));
      if (auto moved = session->move("thumb", {x, y, 0}); !moved) return fail(moved.error());
      if (auto stepped = session->step(); !stepped) return fail(stepped.error());
      if (i < 400) continue;
      low = std::min(low, session->reading("thumb")->force.y);
      high = std::max(high, session->reading("thumb")->force.y);
    }
    std::printf("texture %.1f mm: the force is %.3f to %.3f N\n", 1e3 * amplitude, low, high);
    if (auto moved = session->move("thumb", {0, 0.002, 0}); !moved) return fail(moved.error());
    if (auto stepped = session->step(); !stepped) return fail(stepped.error());
  }
}
