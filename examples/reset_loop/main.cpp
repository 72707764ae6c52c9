// A loop as in reinforcement learning: an external force pushes a cube on a table, the contact below it is read, and
// each trial starts from the same saved state.
#include <pliant/pliant.h>

#include <cmath>
#include <cstdio>

static int fail(const pliant::Error& error) {
  return std::fprintf(stderr, "%s\n", error.message().c_str()), 1;
}

static pliant::MeshData box(float x, float y, float z) {
  pliant::MeshData mesh;
  for (int i = 0; i < 8; ++i) mesh.position.push_back({i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z});
  mesh.index = {0, 5, 4, 0, 1, 5, 2, 7, 3, 2, 6, 7, 0, 3, 1, 0, 2, 3,
                4, 7, 6, 4, 5, 7, 0, 6, 2, 0, 4, 6, 1, 7, 5, 1, 3, 7};
  return mesh;
}

int main() {
  pliant::Scene scene("table");
  scene.simulation().soft_step = 0.005;
  scene.add_rigid_body("table", box(0.3f, 0.02f, 0.3f), {.fixed = true}, {.position = {0, -0.02, 0}});
  scene.add_rigid_body("cube", box(0.02f, 0.02f, 0.02f), {.mass = 0.1}, {.position = {0, 0.02, 0}});
  auto session = pliant::Session::open(scene);
  if (!session) return fail(session.error());
  if (auto s = session->step(200); !s) return fail(s.error());
  const auto begin = session->save_state();
  if (!begin) return fail(begin.error());

  for (const double force : {0.2, 0.6, 0.6}) {  // [N]; friction resists 0.4
    if (auto s = session->restore_state(*begin); !s) return fail(s.error());
    if (auto s = session->set_body_force("cube", {force, 0, 0}); !s) return fail(s.error());
    if (auto s = session->step(200); !s) return fail(s.error());
    std::vector<pliant::BodyContact> contacts;
    if (auto s = session->body_contacts(contacts); !s) return fail(s.error());
    double weight = 0.0;
    for (const pliant::BodyContact& contact : contacts) weight += contact.force.y * (contact.a.object == 1 ? 1 : -1);
    const auto bounds = session->bounds({.object = "cube"});
    if (!bounds) return fail(bounds.error());
    const auto below = session->ray({0.25, 1, 0}, {0, -1, 0});
    if (!below) return fail(below.error());
    std::printf("%.1f N: the cube went %4.1f mm; the table carries %.2f N; beside it is `%s`\n", force,
                1e3 * std::abs(bounds->min.x + 0.02), weight, session->objects()[below->object].c_str());
  }
}
