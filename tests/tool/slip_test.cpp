// Changes of a contact during slip: the contact point moves over both surfaces, and the compliance there changes with
// it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "systems/soft/body/immovable_body.h"
#include "systems/soft/collide/contact_geometry.h"
#include "systems/soft/collide/surface_walk.h"
#include "systems/tool/tool_tick.h"
#include "tests/soft/collision_shapes.h"
#include "tests/tool/press_scene.h"

namespace pliant {
namespace {

// The part of a mesh that make_bar leaves out.
void find_neighbours(Mesh& mesh, float edge) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> at;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) at[{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]}] = t;
  mesh.across.assign(mesh.triangles.size(), uvec3(kBorder));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto found = at.find({mesh.triangles[t][(i + 1) % 3], mesh.triangles[t][i]});
      if (found != at.end()) mesh.across[t][i] = found->second;
    }
  mesh.mean_edge = edge;
}

// A soft bar along x, with its far end as handle, lies on a rigid ridge across it, without friction.
class BarOnRidge {
 public:
  static constexpr double kCell = 0.01, kLong = 0.08, kRidge = 0.02;  // [m]; the ridge is so far from the free end

  BarOnRidge()
      : bar_(make_bar(8, 2, 2, kCell, [](auto i, auto, auto) { return i == 8 ? Role::kHandle : Role::kFree; })) {
    find_neighbours(bar_.collision_mesh, float(kCell));
    ground_ = ground_mesh();
    find_neighbours(ground_, 100.0f);
    bodies_.push_back(std::make_unique<SoftBodyState>(bar_.tets, bar_.collision_mesh, firm_tissue(), &handle_, Pose{}));
    bodies_.push_back(std::make_unique<FixedBody>(ground_, Pose{}));
    model.contacts.resize(kMaxCondensed, kMaxModes);
    rest_ = tool().handle().motion().pose;
  }
  // [N], [N m] on the handle, which has moved by `by` [m] at the step's end.
  Vector6 step(double T, dvec3 by) {
    const Pose end{rest_.position + by, rest_.rotation};
    tool().prescribe_handle({end, join((by - went_) / T, dvec3(0))});
    went_ = by;
    for (auto& body : bodies_) body->free_step(T, dvec3(0));
    contacts_.clear();
    for (const double aside : {0.0, -0.01, 0.01, 0.02, 0.03}) contacts_.push_back(contact(aside));
    build_problem(bodies_, contacts_, T, kUndonePenetration, delassus_, problem_);
    solve(problem_, {200, 1e-12, 0});
    apply_impulses(bodies_, delassus_, contacts_, problem_.impulse);
    keep_impulses(problem_, contacts_);
    reduce_tool({bodies_, contacts_, delassus_, problem_, T, kUndonePenetration}, 0, 1e-3, model);
    for (auto& body : bodies_) body->advance(T);
    return model.force;
  }
  Vector6 settle(dvec3 by) {
    Vector6 wrench;
    for (int i = 1; i <= 60; ++i) wrench = step(0.01, std::min(1.0, i / 30.0) * by);
    return wrench;
  }
  HandleModel model;

 private:
  SoftBodyState& tool() { return static_cast<SoftBodyState&>(*bodies_[0]); }
  // Of the bar's lower face over the ridge at y = 0. Another one, `aside` [m] along the bar, is far below: as in any
  // scene, contacts near those that touch give the model the bar's compliance there.
  ContactPoint contact(double aside) {
    ContactPoint c;
    c.body_a = 0, c.body_b = 1;
    const dvec3 ridge(kRidge + aside, aside == 0.0 ? 0.0 : -0.1, 0.5 * kCell);
    c.b.position = ridge;
    c.over_a = dmat2(-1.0);  // it is touched where the ridge is
    c.mu_static = c.mu_sliding = 0.0;
    const std::vector<dvec3>& x = bodies_[0]->surface_position;
    for (std::uint32_t t = 0; t < bar_.collision_mesh.triangles.size(); ++t) {
      const uvec3 k = bar_.collision_mesh.triangles[t];
      const dvec3 e = x[k.y] - x[k.x], f = x[k.z] - x[k.x], n = cross(e, f), d = ridge - x[k.x];
      if (!(n.y < -0.9 * length(n))) continue;
      const double det = e.x * f.z - e.z * f.x, u = (d.x * f.z - d.z * f.x) / det, v = (e.x * d.z - e.z * d.x) / det;
      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
      c.a = {t, dvec3(1 - u - v, u, v), x[k.x] + u * e + v * f};
      c.normal = -n / length(n);
      const dvec3 t1 = normalize(dvec3(1, 0, 0) - c.normal.x * c.normal);
      c.axes = dmat3(c.normal, t1, cross(c.normal, t1));
      c.gap = dot(c.normal, c.a.position - ridge);
      c.depth = std::max(0.0, -c.gap);
    }
    return c;
  }

  Bar bar_;
  Mesh ground_;
  Handle6 handle_ = firm_handle();
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<ContactPoint> contacts_;
  Delassus delassus_;
  ContactProblem problem_;
  Pose rest_;
  dvec3 went_{0};
};

Vector6 ticked(const HandleModel& model, double way, int ticks) {
  CondensedState state;
  state.resize(kMaxCondensed, kMaxModes);
  state.start(model.contacts);
  TickHandle handle;
  handle.moved = true;
  handle.velocity = model.handle.velocity;
  handle.next = join(dvec3(way / (1e-3 * ticks), 0, 0), dvec3(0));
  Vector6 wrench;
  for (int i = 0; i < ticks; ++i) wrench = condensed_tick(model.contacts, state, {200, 1e-10, 0}, handle);
  return wrench;
}

// A cantilever of length L that lies on a ridge at its end pushes back with about 3 E I / L^3: drawn over the ridge it
// becomes longer and softer, pushed over it shorter and stiffer.
TEST(Slip, ALeverBecomesLongerAsItIsDrawnOverARidge) {
  for (const double way : {4e-3, -4e-3}) {
    const dvec3 pressed(0, -3e-3, 0);
    BarOnRidge scene, other;
    scene.settle(pressed);
    HandleModel still = scene.model;
    const double began = still.force[1];
    const double ended = other.settle(pressed + dvec3(way, 0, 0))[1];
    const double lever = (BarOnRidge::kLong - BarOnRidge::kRidge) / (BarOnRidge::kLong - BarOnRidge::kRidge + way);
    EXPECT_NEAR(ended / began, lever * lever * lever, 0.08);

    const double felt = ticked(still, way, 200)[1];
    EXPECT_NEAR(felt, ended, 0.1 * std::abs(ended - began)) << way;
    for (Rows& m : still.contacts.from_modes_by_slip) m.setZero();
    for (Rows6& m : still.contacts.from_handle_by_slip) m.setZero();
    // Half of it is the slope of the bent bar, which the normal knows.
    EXPECT_GT(std::abs(ticked(still, way, 200)[1] - ended), 0.4 * std::abs(ended - began)) << "it touches where it did";
  }
}

// [J] of the handle's wrench on a hand that moves it around a rectangle in half a second per side, in the second round.
double work_around(const HandleModel& model, const std::array<dvec3, 4>& sides, double& size) {
  CondensedState state;
  state.resize(kMaxCondensed, kMaxModes);
  state.start(model.contacts);
  TickHandle handle;
  handle.moved = true;
  double work = 0.0;
  for (int round = 0; round < 2; ++round) {
    work = size = 0.0;
    for (const dvec3 side : sides)
      for (int i = 0; i < 500; ++i) {
        handle.next = join(side / 0.5, dvec3(0));
        const Vector6 wrench = condensed_tick(model.contacts, state, {200, 1e-10, 0}, handle);
        work += 1e-3 * wrench.dot(handle.velocity);
        size += 1e-3 * std::abs(wrench.dot(handle.velocity));
      }
  }
  return work;
}

// The bar's damping dissipates the same in both directions. A model with inconsistent lever arms and normals would
// return a part of the work in one direction and take it in the other.
TEST(Slip, NothingIsGainedAroundALoop) {
  BarOnRidge scene;
  scene.settle(dvec3(0, -3e-3, 0));
  HandleModel still = scene.model;
  for (Rows& m : still.contacts.from_modes_by_slip) m.setZero();
  for (Rows6& m : still.contacts.from_handle_by_slip) m.setZero();
  for (const double along : {4e-3, -4e-3})
    for (const double down : {1e-3, -1e-3}) {
      const dvec3 x(along, 0, 0), y(0, down, 0);
      for (const auto& sides : {std::array{x, y, -x, -y}, std::array{y, x, -y, -x}}) {
        double size = 0.0, of_still = 0.0;
        const double work = work_around(scene.model, sides, size), damped = work_around(still, sides, of_still);
        EXPECT_LT(work, 0.0);
        EXPECT_NEAR(work, damped, 1e-3 * size) << along << ' ' << down;
      }
    }
}

// An egg of half axes (a, b, c) about the origin.
Mesh egg_mesh(vec3 half, int levels) {
  Primitive p = test::icosphere(levels);
  for (vec3& x : p.position) x *= half;
  return test::mesh_of(p);
}

struct Standing {
  Mesh mesh;
  FixedBody body;
  CollisionMesh collision_mesh;
  Standing(Mesh&& shape, dvec3 at) : mesh(std::move(shape)), body(mesh, Pose{}), collision_mesh(body) {
    for (dvec3& x : body.surface_position) x += at;
    for (int i = 0; i < 2; ++i) collision_mesh.refit(body, 0.01, 1e-3);
  }
};

std::uint32_t lowest_vertex(const Standing& of) {
  std::uint32_t v = 0;
  for (std::uint32_t k = 0; k < of.mesh.vertex_count; ++k)
    if (of.body.surface_position[k].y < of.body.surface_position[v].y) v = k;
  return v;
}

// Two eggs that lie across each other: along its own length, each is flat, and the place of touch stays on the other.
TEST(Slip, ThePlaceOfTouchStaysOnWhatIsMoreCurved) {
  const vec3 half(0.03f, 0.01f, 0.012f), across(half.z, half.y, half.x);
  const Standing upper(egg_mesh(half, 4), dvec3(0, 0.02, 0)), lower(egg_mesh(across, 4), dvec3(0));
  const std::uint32_t v = lowest_vertex(upper);
  const dvec3 foot = upper.body.surface_position[v];
  std::uint32_t below = 0;
  for (std::uint32_t t = 0; t < lower.mesh.triangles.size(); ++t) {
    const auto height = [&](std::uint32_t k) {
      const uvec3 c = lower.mesh.triangles[k];
      const dvec3 m =
          (lower.body.surface_position[c.x] + lower.body.surface_position[c.y] + lower.body.surface_position[c.z]) /
          3.0;
      return length(m - foot);
    };
    if (height(t) < height(below)) below = t;
  }
  const FeaturePair pair{
      upper.collision_mesh, lower.collision_mesh, false, v, below, lower.collision_mesh.normal(below)};
  ContactPoint contact;
  ASSERT_TRUE(look_ahead(pair, contact));
  contact.axes = dmat3(dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, 0, -1));
  find_turning(pair, contact);

  // y = -b sqrt(1 - x^2/a^2 - z^2/c^2): b / a^2 along x, b / c^2 along z.
  const double b = 0.01, along = b / (0.03 * 0.03), aside = b / (0.012 * 0.012);
  const double over_x = along / (along + aside), over_z = aside / (along + aside);
  EXPECT_NEAR(contact.over_b[0][0], over_x, 0.05);
  EXPECT_NEAR(contact.over_b[1][1], over_z, 0.05);
  EXPECT_NEAR(contact.over_b[0][1], 0.0, 0.05);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(contact.over_b[k][i] - contact.over_a[k][i], i == k ? 1.0 : 0.0, 1e-12)
          << "the slip is what they part by";
  const double turning = along * aside / (along + aside);
  EXPECT_NEAR(contact.turning[0][0], turning, 0.2 * turning);
  EXPECT_NEAR(contact.turning[1][1], turning, 0.2 * turning);
}

TEST(Slip, AWalkGoesAsFarAsItSaysAndEndsAtCreases) {
  const double radius = 0.02;
  const Standing ball(test::sphere_mesh(float(radius), 4), dvec3(0)), box(test::block_mesh(vec3(0.02f), 4), dvec3(0));
  const SurfacePoint from = ball.collision_mesh.point_on_triangle(7, dvec3(0.2, 0.3, 0.5));
  const dvec3 by = 0.01 * normalize(cross(from.position, dvec3(0.3, -0.2, 0.7)));
  const auto there = walk(ball.body, from, by);
  ASSERT_TRUE(there);
  EXPECT_NEAR(radius * std::acos(dot(normalize(there->position), normalize(from.position))), 0.01, 2e-4);
  const uvec3 c = ball.mesh.triangles[there->triangle];
  const dvec3 at = there->barycentric.x * ball.body.surface_position[c.x] +
                   there->barycentric.y * ball.body.surface_position[c.y] +
                   there->barycentric.z * ball.body.surface_position[c.z];
  EXPECT_LT(length(at - there->position), 1e-6);

  const SurfacePoint on_box = box.collision_mesh.point_on_triangle(0, dvec3(0.3, 0.3, 0.4));
  const dvec3 aside = normalize(cross(box.collision_mesh.normal(0), dvec3(0.36, 0.48, 0.8)));
  EXPECT_TRUE(walk(box.body, on_box, 0.0005 * aside));
  EXPECT_FALSE(walk(box.body, on_box, 0.04 * aside));
}

}  // namespace
}  // namespace pliant
