// Geometry queries of a session: triangles, contacts by name, the closest point, rays, bounds.
#include <algorithm>
#include <random>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

// Its triangles face outwards.
MeshData cube() {
  MeshData mesh = box(0.02f);
  for (std::size_t i = 0; i < mesh.index.size(); i += 3) std::swap(mesh.index[i + 1], mesh.index[i + 2]);
  return mesh;
}

// A soft cube and a rigid one on a fixed floor, both a little above it; a pressed sheet far to the left.
Scene bodies() {
  Scene scene("bodies");
  scene.simulation().soft_step = 0.005;
  scene.add_surface("tissue", sheet(), {.stiffness = 300.0}, {.position = {-0.5, 0, 0}});
  scene.add_rigid_body("floor", sheet(0.2, 8), {.fixed = true});
  scene.add_soft_body("liver", cube(), {.young = 2e4, .rayleigh = {2.0, 0.002}, .cell = 0.02},
                      {.position = {-0.05, 0.021, 0}});
  scene.add_rigid_body("box", cube(), {}, {.position = {0.05, 0.021, 0}});
  scene.add_probe("finger", {.radius = 0.005}, {}, {.position = {-0.05, 0.06, 0}});
  return scene;
}

std::size_t object_of(const Session& session, const std::string& name) {
  const std::vector<std::string>& all = session.objects();
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
}

struct Soup {
  std::vector<vec3> vertices;
  std::vector<std::uint32_t> index;
  dvec3 at(std::size_t corner) const { return dvec3(vertices[index[corner]]); }
};
Soup soup_of(Session& session, const std::string& object) {
  Soup soup;
  EXPECT_TRUE(session.vertices(object, soup.vertices));
  EXPECT_TRUE(session.triangles(object, soup.index));
  return soup;
}

// By bisection along the edges and inside (no formula of the library's): Ericson's regions.
double distance_to(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return length(ap);
  const dvec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return length(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return length(p - (a + d1 / (d1 - d3) * ab));
  const dvec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return length(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return length(p - (a + d2 / (d2 - d6) * ac));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return length(p - (b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)));
  const double sum = va + vb + vc;
  return length(p - (a + vb / sum * ab + vc / sum * ac));
}

// [m] along the ray, or infinity.
double along_ray(dvec3 from, dvec3 way, dvec3 a, dvec3 b, dvec3 c) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  const dvec3 p = cross(way, c - a);
  const double det = dot(b - a, p);
  if (std::abs(det) < 1e-300) return kNothing;
  const double u = dot(from - a, p) / det;
  const dvec3 q = cross(from - a, b - a);
  const double v = dot(way, q) / det, t = dot(c - a, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? t : kNothing;
}

// The bodies have fallen, and the finger presses the soft one and dents the sheet's neighbour.
Session settled() {
  Session session = opened(bodies());
  for (int i = 0; i < 300; ++i) {
    EXPECT_TRUE(session.move("finger", {-0.05, 0.06 - 7e-5 * i, 0}));
    EXPECT_TRUE(session.step());
  }
  return session;
}

TEST(SessionQuery, BodiesGiveTheirTrianglesInTheOrderOfWhatWasGiven) {
  Session session = settled();
  for (const std::string name : {"liver", "box"}) {
    const Soup soup = soup_of(session, name);
    EXPECT_EQ(soup.index, cube().index) << name;
    ASSERT_EQ(soup.vertices.size(), 8u) << name;
    double volume = 0.0;  // positive: they face outwards
    for (std::size_t i = 0; i < soup.index.size(); i += 3)
      volume += dot(soup.at(i), cross(soup.at(i + 1), soup.at(i + 2))) / 6.0;
    EXPECT_NEAR(volume, 6.4e-5, 0.3 * 6.4e-5) << name;
    const auto geometry = session.geometry(name);
    ASSERT_TRUE(geometry) << geometry.error().message();
    EXPECT_EQ(geometry->index, soup.index);
    EXPECT_EQ(geometry->position, cube().position);
  }
  EXPECT_EQ(soup_of(session, "tissue").index, sheet().index);
  EXPECT_FALSE(session.geometry("finger"));
}

TEST(SessionQuery, TrianglesThatAreGivenInsideOutAreTurned) {
  Scene scene("turned");
  scene.add_rigid_body("box", box(0.02f));
  Session session = opened(scene);
  const auto hit = session.closest_point({0, 1, 0});
  ASSERT_TRUE(hit && hit->found());
  EXPECT_GT(hit->normal.y, 0.99);
}

TEST(SessionQuery, ContactsNameBothSidesWithDepthAndVertex) {
  Session session = settled();
  std::vector<BodyContact> contacts;
  ASSERT_TRUE(session.body_contacts(contacts));
  const auto floor = object_of(session, "floor"), cube = object_of(session, "box"), liver = object_of(session, "liver");
  bool on_floor = false, by_finger = false;
  std::vector<vec3> vertices;
  for (const BodyContact& contact : contacts) {
    for (const auto& [own, other] : {std::pair(contact.a, contact.b), std::pair(contact.b, contact.a)}) {
      if (own.object == cube && other.object == floor) {
        on_floor = true;
        ASSERT_TRUE(session.vertices("box", vertices));
        ASSERT_LT(own.vertex, 8u);
        ASSERT_LT(own.triangle, 12u);
        EXPECT_LT(length(dvec3(vertices[own.vertex]) - contact.position), 0.03);
        EXPECT_LT(vertices[own.vertex].y, 0.005f) << "one of those below";
        EXPECT_LT(contact.depth, 1e-3);
        EXPECT_GT(contact.depth, -1e-2);
        EXPECT_EQ(own.effector, ContactSide::kNone);
      }
      if (own.effector == 0 && other.object == liver) {
        by_finger = true;
        EXPECT_EQ(own.object, ContactSide::kNone);
        EXPECT_EQ(own.vertex, ContactSide::kNone);
        EXPECT_LT(other.triangle, 12u);
        ASSERT_TRUE(session.vertices("liver", vertices));
        EXPECT_GT(vertices[other.vertex].y, 0.03f) << "one of those on top";
      }
    }
  }
  EXPECT_TRUE(on_floor);
  EXPECT_TRUE(by_finger);
}

TEST(SessionQuery, ForcesOnVerticesAddUpToThoseOfTheContacts) {
  Session session = settled();
  std::vector<BodyContact> contacts;
  ASSERT_TRUE(session.body_contacts(contacts));
  dvec3 of_all(0);
  for (const std::string name : {"liver", "box", "floor"}) {
    std::vector<vec3> force;
    ASSERT_TRUE(session.vertex_forces(name, force));
    dvec3 sum(0), of_contacts(0);
    for (const vec3 f : force) sum += dvec3(f);
    for (const BodyContact& contact : contacts) {
      if (contact.a.object == object_of(session, name)) of_contacts += contact.force;
      if (contact.b.object == object_of(session, name)) of_contacts -= contact.force;
    }
    EXPECT_GT(length(of_contacts), 0.1) << name;
    EXPECT_LT(length(sum - of_contacts), 1e-5) << name;
    if (name == "liver") EXPECT_LT(force[2].y + force[3].y + force[6].y + force[7].y, 0.0f) << "pressed on its top";
    of_all += sum;
  }
  const double pressed = session.reading("finger")->force.y;
  EXPECT_GT(pressed, 0.05);
  EXPECT_NEAR(of_all.y, -pressed, 0.05 * pressed) << "all other forces are in pairs";
}

TEST(SessionQuery, ASurfacesContactSaysItsTriangleAndNearestVertex) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.move("finger", {0.0113, 0.001, 0.0077}));
  ASSERT_TRUE(session.step(5));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(session.move("finger", {0.0113, 0.001 - 2e-5 * i, 0.0077}));
    ASSERT_TRUE(session.step());
  }
  const auto reading = session.reading("finger");
  ASSERT_EQ(reading->contacts, 1u);
  const ContactReading& contact = reading->contact[0];
  const MeshData mesh = sheet();
  double nearest = 1.0;
  std::uint32_t vertex = 0;
  for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
    const double d = length(dvec3(mesh.position[v]) - contact.position);
    if (d < nearest) nearest = d, vertex = v;
  }
  EXPECT_EQ(contact.vertex, vertex);
  const std::uint32_t* corner = &mesh.index[3 * contact.triangle];
  EXPECT_LT(distance_to(contact.position, dvec3(mesh.position[corner[0]]), dvec3(mesh.position[corner[1]]),
                        dvec3(mesh.position[corner[2]])),
            1e-6);
}

TEST(SessionQuery, AnswersAreThoseOfTryingEveryTriangle) {
  Session session = settled();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.12, 0.12), unit(-1.0, 1.0);
  for (const std::string name : {"liver", "box", "floor"}) {
    const Soup soup = soup_of(session, name);
    for (int n = 0; n < 200; ++n) {
      const dvec3 p{place(random), place(random), place(random)}, way{unit(random), unit(random), unit(random)};
      double nearest = std::numeric_limits<double>::infinity(), first = nearest;
      for (std::size_t i = 0; i < soup.index.size(); i += 3) {
        nearest = std::min(nearest, distance_to(p, soup.at(i), soup.at(i + 1), soup.at(i + 2)));
        first = std::min(first, along_ray(p, way / length(way), soup.at(i), soup.at(i + 1), soup.at(i + 2)));
      }
      const auto hit = session.closest_point(p, {.object = name});
      ASSERT_TRUE(hit && hit->found());
      EXPECT_NEAR(hit->distance, nearest, 1e-12) << name;
      EXPECT_NEAR(length(hit->position - p), nearest, 1e-12);
      EXPECT_NEAR(length(hit->normal), 1.0, 1e-12);
      dvec3 again(0);
      for (int k = 0; k < 3; ++k)
        again += hit->barycentric[k] * soup.at(3 * hit->triangle + static_cast<std::size_t>(k));
      EXPECT_LT(length(again - hit->position), 1e-12);
      const auto met = session.ray(p, way, {.object = name});
      ASSERT_TRUE(met);
      ASSERT_EQ(met->found(), std::isfinite(first)) << name << ' ' << n;
      if (met->found()) EXPECT_NEAR(met->distance, first, 1e-9) << name;
    }
    const auto bounds = session.bounds({.object = name});
    ASSERT_TRUE(bounds);
    dvec3 low(1), high(-1);
    for (const vec3& v : soup.vertices) low = glm::min(low, dvec3(v)), high = glm::max(high, dvec3(v));
    EXPECT_EQ(bounds->min, low);
    EXPECT_EQ(bounds->max, high);
  }
}

TEST(SessionQuery, ADentedSurfaceAnswersDeformedAndAtRest) {
  Session session = opened(press_scene());
  press(session, 0.004);
  const auto dented = session.ray({0, 0.1, 0}, {0, -2, 0}), rest = session.ray({0, 0.1, 0}, {0, -1, 0}, {.rest = true});
  ASSERT_TRUE(dented && dented->found());
  ASSERT_TRUE(rest && rest->found());
  EXPECT_NEAR(rest->distance, 0.1, 1e-9);
  EXPECT_NEAR(dented->distance, 0.104, 1e-5);
  EXPECT_EQ(session.objects()[dented->object], "tissue");
  ASSERT_TRUE(session.move("finger", {0, 0.02, 0}));
  ASSERT_TRUE(session.step(2000));
  EXPECT_NEAR(session.ray({0, 0.1, 0}, {0, -1, 0})->distance, 0.1, 1e-4) << "it has come back";
}

TEST(SessionQuery, NearestOfAllObjectsAndNothingBeyondTheLimit) {
  Session session = settled();
  const auto hit = session.closest_point({0.05, 0.2, 0});
  ASSERT_TRUE(hit && hit->found());
  EXPECT_EQ(hit->object, object_of(session, "box"));
  EXPECT_FALSE(session.closest_point({0.05, 0.2, 0}, {.within = 0.1})->found());
  EXPECT_FALSE(session.ray({0.05, 0.2, 0}, {0, -1, 0}, {.within = 0.1})->found());
  EXPECT_FALSE(session.ray({0.05, 0.2, 0}, {0, 1, 0})->found());
  const double nan = std::nan("");
  EXPECT_FALSE(session.closest_point({nan, 0, 0}));
  EXPECT_FALSE(session.ray({0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(session.closest_point({0, 0, 0}, {.within = -1.0}));
  EXPECT_FALSE(session.closest_point({0, 0, 0}, {.object = "nobody"}));
}

TEST(SessionQuery, RealTimeAnswersWhileTheClocksRun) {
  Session session = opened(bodies());
  ASSERT_TRUE(session.move("finger", {-0.05, 0.1, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_TRUE(within_five_seconds([&] {
    const auto hit = session.ray({0.05, 0.2, 0}, {0, -1, 0}, {.object = "box"});
    return hit && hit->found() && hit->distance > 0.1595;  // it has fallen by 1 mm
  }));
  std::vector<BodyContact> contacts;
  EXPECT_TRUE(within_five_seconds([&] { return session.body_contacts(contacts) && !contacts.empty(); }));
  EXPECT_TRUE(session.stop());
}

}  // namespace
}  // namespace pliant
