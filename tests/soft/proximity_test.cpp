// The search for contacts against a brute-force reference, and against its purpose: nothing passes through anything.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "systems/soft/collide/collision_mesh.h"
#include "systems/soft/collide/meeting.h"
#include "systems/soft/collide/mesh_pairs.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kProximityStep = 1.0 / 60.0;  // [s]

// A collision mesh whose vertices move as the test prescribes.
class ScriptedBody : public FixedBody {
 public:
  explicit ScriptedBody(const Mesh& mesh) : FixedBody(mesh, {}) {}
  int size() const override { return 1; }  // so that it is not taken for ground
  void free_step(double, dvec3) override {}
  // From where the vertices are to `where`(rest position) within T.
  template <class Where>
  void move_to(double T, Where where) {
    for (std::uint32_t v = 0; v < collision_mesh->vertex_count; ++v)
      surface_velocity[v] = (where(dvec3(collision_mesh->position(v))) - surface_position[v]) / T;
  }
  void arrive(double T) {
    for (std::size_t v = 0; v < surface_position.size(); ++v) surface_position[v] += T * surface_velocity[v];
  }
};

// A wobbling blob: waves on a sphere, rotating and moving.
struct Wobble {
  dvec3 from, velocity, axis, wave;
  double spin;
  dvec3 operator()(dvec3 x, double t) const {
    const dvec3 waved = x * (1.0 + 0.25 * std::sin(dot(wave, x) + 9.0 * t));
    return from + t * velocity + glm::angleAxis(spin * t, axis) * waved;
  }
};

// Corner i of triangle s with triangle t; edge i with edge k: if that triangle is the one to look at them.
bool vertex_meets(const CollisionMesh& a, std::uint32_t s, int i, const CollisionMesh& b, std::uint32_t t,
                  const Reach& reach) {
  const std::uint32_t v = a.mesh().triangles[s][i];
  return (a.live(s) & 1u << i) && dot(a.vertex_normal(v), b.normal(t)) <= kFacing &&
         meet_triangle(a.vertex(v), b.triangle(t), reach);
}
bool edges_meet(const CollisionMesh& a, std::uint32_t s, int i, const CollisionMesh& b, std::uint32_t t, int k,
                const Reach& reach) {
  const std::uint32_t e = a.edge_of(s, i), f = b.edge_of(t, k);
  return (a.live(s) & 8u << i) && (b.live(t) & 8u << k) && dot(a.edge_normal(e), b.edge_normal(f)) <= kFacing &&
         meet_edge(a.edge(e), a.edge_shape(e), b.edge(f), b.edge_shape(f), reach);
}

TEST(Proximity, TheTreesMissNoMeetingThatBruteForceFinds) {
  const Mesh mesh = test::sphere_mesh(0.05f, 2);
  const Reach reach{4e-3, 4e-3};
  int meetings = 0;
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    std::mt19937 random(seed);
    std::array<ScriptedBody, 2> body{ScriptedBody(mesh), ScriptedBody(mesh)};
    std::array<Wobble, 2> path;
    const dvec3 apart = test::random_direction(random) * 0.047;
    for (int i = 0; i < 2; ++i) {
      const dvec3 from = i == 0 ? apart : -apart;
      path[i] = {from, -from / 0.1, test::random_direction(random), test::random_direction(random) * 60.0, 8.0};
    }
    std::array<CollisionMesh, 2> collision_mesh{CollisionMesh(body[0]), CollisionMesh(body[1])};
    for (int step = 0; step < 3; ++step) {
      for (int i = 0; i < 2; ++i) {
        body[i].move_to(1.0, [&](dvec3 x) { return path[i](x, step * kProximityStep); });
        body[i].arrive(1.0);
        body[i].move_to(kProximityStep, [&](dvec3 x) { return path[i](x, (step + 1) * kProximityStep); });
        collision_mesh[i].refit(body[i], kProximityStep, 0.5 * std::max(reach.front, reach.behind));
      }
      std::set<std::pair<std::uint32_t, std::uint32_t>> visited;
      for_each_pair(collision_mesh[0], collision_mesh[1], [&](std::uint32_t s, std::uint32_t t) {
        visited.insert({s, t});
      });
      const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
      for (std::uint32_t s = 0; s < triangles; ++s)
        for (std::uint32_t t = 0; t < triangles; ++t) {
          bool meets = false;
          for (int i = 0; i < 3 && !meets; ++i) {
            meets |= vertex_meets(collision_mesh[0], s, i, collision_mesh[1], t, reach) ||
                     vertex_meets(collision_mesh[1], t, i, collision_mesh[0], s, reach);
            for (int k = 0; k < 3 && !meets; ++k)
              meets |= edges_meet(collision_mesh[0], s, i, collision_mesh[1], t, k, reach);
          }
          if (!meets) continue;
          ++meetings;
          EXPECT_TRUE(visited.count({s, t})) << "seed " << seed << " step " << step << ": " << s << ' ' << t;
        }
    }
  }
  EXPECT_GT(meetings, 200);
}

TEST(Proximity, EveryVertexAndEdgeIsLookedAtOnce) {
  const Mesh mesh = test::sphere_mesh(0.05f, 3);
  const ScriptedBody body(mesh);
  const CollisionMesh collision_mesh(body);
  std::vector<int> vertices(mesh.vertex_count), edges(collision_mesh.edges().size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      vertices[mesh.triangles[t][i]] += (collision_mesh.owned(t) >> i) & 1;
      edges[collision_mesh.edge_of(t, i)] += (collision_mesh.owned(t) >> (3 + i)) & 1;
    }
  EXPECT_EQ(edges.size(), mesh.triangles.size() * 3 / 2);
  EXPECT_TRUE(std::all_of(vertices.begin(), vertices.end(), [](int n) { return n == 1; }));
  EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](int n) { return n == 1; }));
}

TEST(Proximity, CrossingsAreFoundAtTheirInstant) {
  // A point that falls through a triangle which itself rises and turns: sampled sign changes are the twin.
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int found = 0, sampled = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::array<Moving, 4> p;
    for (Moving& m : p)
      m = {{normal(random), normal(random), normal(random)}, {normal(random), normal(random), normal(random)}};
    const auto volume = [&](double t) {
      return dot(cross(p[1].at(t) - p[0].at(t), p[2].at(t) - p[0].at(t)), p[3].at(t) - p[0].at(t));
    };
    std::array<double, 3> times;
    const int count = find_crossings(p[0], p[1], p[2], p[3], times);
    found += count;
    for (int i = 0; i < count; ++i) EXPECT_NEAR(volume(times[i]), 0.0, 1e-10);
    const int samples = 2000;
    int falling = 0;
    for (int i = 0; i < samples; ++i)
      falling += volume(double(i) / samples) >= 0.0 && volume(double(i + 1) / samples) < 0.0;
    sampled += falling;
    EXPECT_GE(count, falling) << trial;
  }
  EXPECT_GT(sampled, 50);
  EXPECT_LE(found, sampled + 2);  // two roots within a sample are not seen by the twin
}

// At 5 m/s a body moves 83 mm in a step and rotates by more than a radian in the step in which it is stopped: contacts
// limit the first order of this motion, the second is corrected afterwards. A flat collision mesh, tilted by 0.2 rad
// about its edge, comes down on a ridge. If it lies flat when the edges cross, they touch; if it stays tilted, the part
// lower than its edge does.
TEST(Proximity, EdgesMeetIfTheySupportEachOtherWhereTheyCross) {
  const std::array<Moving, 2> edge{Moving{{-0.01, 0.002, 0.0}, {0, -0.003, 0}},
                                   Moving{{0.01, 0.002, 0.0}, {0, -0.003, 0}}};
  const std::array<Moving, 2> ridge{Moving{{0, 0, -0.01}}, Moving{{0, 0, 0.01}}};
  const dvec3 tilted(0, -std::sin(0.2), std::cos(0.2)), back(0, std::sin(0.1), std::cos(0.1));
  const EdgeShape of_ridge{dvec3(0, 1, 0), {dvec3(0, -1, 0), dvec3(0, -1, 0)}};
  EdgeShape of_edge{dvec3(0, -2, 0), {tilted, -tilted}};
  EXPECT_FALSE(meet_edge(edge, of_edge, ridge, of_ridge, {1e-4, 1e-4}));
  of_edge.turning = {back - tilted, tilted - back};
  const std::optional<Meeting> m = meet_edge(edge, of_edge, ridge, of_ridge, {1e-4, 1e-4});
  ASSERT_TRUE(m);
  EXPECT_TRUE(m->crosses);
  EXPECT_NEAR(m->normal.y, 1.0, 1e-12);
  EXPECT_NEAR(m->gap, 0.002, 1e-12);
  EXPECT_NEAR(m->end_gap, -0.001, 1e-12);
}

TEST(Proximity, NormalsDoNotFlipWhileABallIsPressedHalfThrough) {
  const Mesh ball = test::sphere_mesh(0.02f, 3), slab = test::block_mesh(vec3(0.2f, 0.02f, 0.2f), 8);
  std::vector<std::unique_ptr<Body>> bodies;
  bodies.push_back(std::make_unique<ScriptedBody>(slab));
  bodies.push_back(std::make_unique<ScriptedBody>(ball));
  auto& moving = static_cast<ScriptedBody&>(*bodies[1]);
  Proximity proximity(bodies);
  std::vector<ContactPoint> contacts;
  const auto place = [](double depth) { return [depth](dvec3 x) { return x + dvec3(0.003, 0.03 - depth, 0.001); }; };
  moving.move_to(1.0, place(-0.002));
  moving.arrive(1.0);
  for (int step = 0; step < 200; ++step) {
    const double depth = -0.002 + 7e-5 * (step + 1);  // ends at 12 mm: past the middle of the slab
    moving.move_to(kProximityStep, place(depth));
    proximity.find(bodies, kProximityStep, 2e-3, contacts);
    double deepest = 1e300;
    for (const ContactPoint& c : contacts) {
      const dvec3 up = c.body_a == 1 ? c.normal : -c.normal;
      EXPECT_GT(up.y, 0.3) << "depth " << depth;
      deepest = std::min(deepest, c.gap);
    }
    if (depth > 0.0) {
      ASSERT_FALSE(contacts.empty()) << depth;
      EXPECT_NEAR(deepest, -(depth - 7e-5), 2e-4) << depth;
    }
    moving.arrive(kProximityStep);
  }
}

// A pin pushed into a plate farther than its middle: the far side is then the nearer.
TEST(Proximity, WhatEntersAThinPlateIsSentBackWhereItCameFrom) {
  const Mesh plate = test::block_mesh(vec3(0.1f, 0.003f, 0.1f), 1), ball = test::sphere_mesh(0.02f, 4);
  std::vector<std::unique_ptr<Body>> bodies;
  bodies.push_back(std::make_unique<ScriptedBody>(plate));
  bodies.push_back(std::make_unique<ScriptedBody>(ball));
  auto& moving = static_cast<ScriptedBody&>(*bodies[1]);
  const auto place = [](double depth) {
    return [depth](dvec3 x) { return dvec3(0.2 * x.x, x.y, 0.2 * x.z) + dvec3(0.003, 0.0215 - depth, 0.001); };
  };
  moving.move_to(1.0, place(-0.001));
  moving.arrive(1.0);
  Proximity proximity(bodies);
  std::vector<ContactPoint> contacts;
  for (int step = 0; step < 60; ++step) {
    const double depth = -0.001 + 6e-5 * (step + 1);  // ends at 2.6 mm of 3 mm
    moving.move_to(kProximityStep, place(depth));
    proximity.find(bodies, kProximityStep, 3e-3, contacts);
    bool sent_back = false;
    for (const ContactPoint& c : contacts) {
      if (c.body_a != 1) continue;
      EXPECT_GT(c.normal.y, -0.3) << depth;
      sent_back |= c.normal.y > 0.9 && c.gap < 1e-3 - depth;
    }
    EXPECT_TRUE(sent_back) << depth;
    moving.arrive(kProximityStep);
  }
}

TEST(Proximity, AVertexInsideWithoutAPastIsPushedOutTheNearestWay) {
  const Mesh small = test::block_mesh(vec3(0.02f)), slab = test::block_mesh(vec3(0.1f, 0.01f, 0.1f), 4);
  for (const double side : {-1.0, 1.0}) {
    std::vector<std::unique_ptr<Body>> bodies;
    bodies.push_back(std::make_unique<ScriptedBody>(slab));
    bodies.push_back(std::make_unique<ScriptedBody>(small));
    auto& moving = static_cast<ScriptedBody&>(*bodies[1]);
    moving.move_to(1.0, [&](dvec3 x) { return x + dvec3(0.003, side * (0.005 + 0.01 - 0.0008), 0.001); });
    moving.arrive(1.0);
    moving.move_to(1.0, [&](dvec3 x) { return x + dvec3(0.003, side * (0.005 + 0.01 - 0.0008), 0.001); });
    Proximity proximity(bodies);
    std::vector<ContactPoint> contacts;
    proximity.find(bodies, kProximityStep, 1e-3, contacts);
    ASSERT_GE(contacts.size(), 4u);
    for (const ContactPoint& c : contacts) {
      EXPECT_NEAR((c.body_a == 1 ? c.normal : -c.normal).y, side, 1e-6);
      EXPECT_NEAR(c.gap, -0.0008, 1e-7);
    }
  }
}

// Two fingers on a palm, each 10 mm thick, 20 mm apart, 60 mm long.
struct Fingers {
  Mesh mesh = test::voxel_mesh(16, 28, 4, vec3(0.0025f), vec3(-0.02f, -0.01f, -0.005f),
                               [](int i, int j, int) { return j < 4 || i < 4 || i >= 12; });
  // Bends both fingers inwards by `angle` over their length.
  static dvec3 bend(dvec3 x, double angle) {
    if (x.y <= 0.0) return x;
    const double side = x.x < 0.0 ? 1.0 : -1.0, root = -0.015 * side, k = angle / 0.06, phi = k * x.y;
    const double across = (x.x - root) * side;
    if (angle == 0.0) return x;
    const double r = 1.0 / k;
    return {root + side * (r - (r - across) * std::cos(phi)), (r - across) * std::sin(phi), x.z};
  }
};

TEST(Proximity, FingersOfOneHandMeetAndNeighboursDoNot) {
  const Fingers fingers;
  std::vector<std::unique_ptr<Body>> bodies;
  bodies.push_back(std::make_unique<ScriptedBody>(fingers.mesh));
  auto& hand = static_cast<ScriptedBody&>(*bodies[0]);
  hand.self_collides = true;
  Proximity proximity(bodies);
  std::vector<ContactPoint> contacts;
  int touching_steps = 0, apart_steps = 0;
  for (int step = 0; step <= 60; ++step) {
    const double angle = 0.385 * step / 60.0;
    hand.move_to(kProximityStep, [&](dvec3 x) { return Fingers::bend(x, angle); });
    double closest = 1e300;  // of the two inner sides, at the end of the step
    for (std::uint32_t v = 0; v < fingers.mesh.vertex_count; ++v)
      if (fingers.mesh.px[v] < -0.001f && fingers.mesh.py[v] > 0.0f)
        closest = std::min(closest, -2.0 * Fingers::bend(dvec3(fingers.mesh.position(v)), angle).x);
    proximity.find(bodies, kProximityStep, 1e-3, contacts);
    if (closest > 1e-3) {
      ++apart_steps;
      EXPECT_TRUE(contacts.empty()) << "angle " << angle << ", apart " << closest;
    }
    if (closest < 0.5e-3) {
      ++touching_steps;
      EXPECT_FALSE(contacts.empty()) << angle;
    }
    for (const ContactPoint& c : contacts) {
      const float xa = fingers.mesh.px[fingers.mesh.triangles[c.a.triangle].x];
      const float xb = fingers.mesh.px[fingers.mesh.triangles[c.b.triangle].x];
      EXPECT_LT(xa * xb, 0.0f) << "one finger with itself";
      EXPECT_GT(c.normal.x * (xa < 0.0f ? -1.0 : 1.0), 0.3);
    }
    hand.arrive(kProximityStep);
  }
  EXPECT_GT(touching_steps, 5);
  EXPECT_GT(apart_steps, 5);
}

TEST(Proximity, AHandOnAnObjectHasTensOfContactsAndKeepsThem) {
  const Mesh ball = test::sphere_mesh(0.04f, 4), ground = test::block_mesh(vec3(0.3f, 0.1f, 0.3f), 24);
  std::vector<std::unique_ptr<Body>> bodies;
  bodies.push_back(std::make_unique<ScriptedBody>(ground));
  bodies.push_back(std::make_unique<ScriptedBody>(ball));
  auto& moving = static_cast<ScriptedBody&>(*bodies[1]);
  // Flattened where it rests, as tissue would be.
  const auto pressed = [](dvec3 x) {
    x.y = std::max(x.y, -0.03) + 0.08 + 1e-4;
    return x;
  };
  moving.move_to(1.0, pressed);
  moving.arrive(1.0);
  moving.move_to(1.0, pressed);
  Proximity proximity(bodies);
  std::vector<ContactPoint> contacts;
  proximity.find(bodies, kProximityStep, 1e-3, contacts);
  EXPECT_GE(contacts.size(), 20u);
  EXPECT_LE(contacts.size(), 60u);
  std::set<std::uint64_t> keys;
  for (ContactPoint& c : contacts) {
    keys.insert(c.key);
    c.impulse = dvec3(1, 2, 3);
  }
  EXPECT_EQ(keys.size(), contacts.size());
  proximity.find(bodies, kProximityStep, 1e-3, contacts);
  for (const ContactPoint& c : contacts) {
    EXPECT_TRUE(keys.count(c.key));
    EXPECT_EQ(c.impulse, dvec3(1, 2, 3));
  }
}

TEST(Proximity, ContactAxesAreOrthonormalAndTurnSteadily) {
  const Mesh block = test::block_mesh(vec3(0.05f), 2), ground = test::block_mesh(vec3(0.5f, 0.1f, 0.5f));
  std::vector<std::unique_ptr<Body>> bodies;
  bodies.push_back(std::make_unique<ScriptedBody>(ground));
  bodies.push_back(std::make_unique<ScriptedBody>(block));
  Proximity proximity(bodies);
  std::vector<ContactPoint> contacts, last;
  const auto at = [](double angle) {
    const dquat r = glm::angleAxis(angle, dvec3(1, 0, 0));
    return std::pair{[r](dvec3 x) { return r * (x + dvec3(0, 0.0752, 0)); }, [r](dvec3 x) { return r * x; }};
  };
  for (int step = 0; step < 200; ++step) {
    const auto [block_at, ground_at] = at(step * 0.03);
    for (auto& body : bodies) {
      auto& scripted = static_cast<ScriptedBody&>(*body);
      if (&body == &bodies[1])
        scripted.move_to(1.0, block_at);
      else
        scripted.move_to(1.0, ground_at);
      scripted.arrive(1.0);
      std::fill(scripted.surface_velocity.begin(), scripted.surface_velocity.end(), dvec3(0));
    }
    proximity.find(bodies, kProximityStep, 1e-3, contacts);
    ASSERT_GE(contacts.size(), 4u);
    for (const ContactPoint& c : contacts) {
      const dmat3 unit = glm::transpose(c.axes) * c.axes;
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(unit[i][k], i == k, 1e-12);
      EXPECT_NEAR(glm::determinant(c.axes), 1.0, 1e-12);
      for (const ContactPoint& l : last)
        if (l.key == c.key && dot(l.normal, c.normal) > 0.5) EXPECT_GT(dot(l.axes[1], c.axes[1]), 0.99);
    }
    last = contacts;
  }
}

}  // namespace
}  // namespace pliant
