// Organs from HRA (in the corpus), touched as surfaces and as tissue. Forces stay finite and within the device's limit;
// elements are well-shaped; tissue is where it should be. The cost of a run is bounded by the number of tetrahedra, not
// by the measured time, which is only printed.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "content/level/soft_preview.h"
#include "content/level_file.h"
#include "content/tets/lattice.h"
#include "content/tets/surface_shape.h"
#include "pliant/session.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
const fs::path kOrgans = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra";

struct Organ {
  const char *file, *node;
};
constexpr Organ kSurfaces[] = {{"VH_M_Liver.glb", "VH_M_liver_capsule"},
                               {"VH_M_Liver.glb", "VH_M_caudate_lobe_of_liver"},
                               {"VH_M_Liver.glb", "VH_M_right_anteroinferior_segment"},
                               {"VH_F_Liver.glb", "VH_F_capsule_of_the_liver"},
                               {"VH_F_Heart.glb", "VH_F_left_ventricle"},
                               {"VH_F_Heart.glb", "VH_F_right_ventricle"},
                               {"VH_F_Heart.glb", "VH_F_right_cardiac_atrium"},
                               {"VH_F_Heart.glb", "VH_F_interventricular_septum"},
                               {"VH_F_Heart.glb", "VH_F_aortic_valve"},
                               {"VH_F_Kidney_L.glb", "VH_F_kidney_capsule_L"},
                               {"VH_F_Kidney_L.glb", "VH_F_outer_cortex_of_kidney_L"},
                               {"VH_F_Kidney_L.glb", "VH_F_renal_pyramid_L_a"}};
constexpr Organ kTissues[] = {{"VH_M_Liver.glb", "VH_M_liver_capsule"},
                              {"VH_F_Heart.glb", "VH_F_interventricular_septum"},
                              {"VH_F_Heart.glb", "VH_F_left_ventricle"},
                              {"VH_F_Heart.glb", "VH_F_right_cardiac_atrium"},
                              {"VH_F_Kidney_L.glb", "VH_F_kidney_capsule_L"}};

constexpr double kMostForce = 3.3;  // [N] of the device
// Under a sanitizer, only the beginning.
#ifdef PLIANT_SANITIZED
constexpr std::size_t kOrgansTried = 2;
constexpr int kDown = 100;
#else
constexpr std::size_t kOrgansTried = 12;
constexpr int kDown = 400;  // ticks of 1 ms
#endif

// The organ's triangles about the origin. [m]
MeshData mesh_of(const Organ& organ, Box& box) {
  MeshData mesh;
  const Result<Level> level = load_level(kOrgans / organ.file);
  EXPECT_TRUE(level.ok()) << level.error().message();
  if (!level) return mesh;
  for (const LevelNode& node : level->nodes) {
    if (node.name != organ.node || node.mesh < 0) continue;
    for (const Primitive& p : level->meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      const auto first = static_cast<std::uint32_t>(mesh.position.size());
      mesh.position.insert(mesh.position.end(), p.position.begin(), p.position.end());
      for (const std::uint32_t v : p.index) mesh.index.push_back(first + v);
    }
  }
  EXPECT_FALSE(mesh.index.empty()) << organ.node;
  for (const vec3& p : mesh.position) box.add(p);
  const vec3 centre = box.center();
  for (vec3& p : mesh.position) p -= centre;
  box = {box.min - centre, box.max - centre};
  return mesh;
}

vec3 topmost(const MeshData& mesh) {
  vec3 top = mesh.position.front();
  for (const vec3& p : mesh.position)
    if (p.y > top.y) top = p;
  return top;
}

// A finger above the topmost vertex. From elsewhere it would have to approach too fast for a hand.
void add_finger(Scene& scene, double radius, vec3 top, double above) {
  ProbeParameters probe;
  probe.radius = radius;
  DeviceParameters device;
  device.max_force = kMostForce;
  Placement placement;
  placement.position = dvec3(top) + dvec3(0, above, 0);
  scene.add_probe("finger", probe, device, placement);
}

// Straight down onto the topmost vertex until its centre is `depth` [m] below it, and up again; returns the largest
// force. [N]
double press(Session& session, const Organ& organ, vec3 top, double depth, double begin) {
  double most = 0.0;
  for (int tick = 0; tick < 2 * kDown; ++tick) {
    const double down = 1.0 - std::abs(static_cast<double>(tick) / kDown - 1.0);
    EXPECT_TRUE(session.move("finger", dvec3(top) + dvec3(0, begin - (begin + depth) * down, 0)));
    EXPECT_TRUE(session.step());
    const Result<Reading> reading = session.reading("finger");
    EXPECT_TRUE(reading.ok());
    const double force = length(reading->force);
    EXPECT_TRUE(std::isfinite(force)) << organ.node << " at tick " << tick;
    if (!std::isfinite(force)) break;
    most = std::max(most, force);
  }
  return most;
}

TEST(Organs, AsSurfacesAllArePressedWithForcesWithinTheLimit) {
  if (!fs::exists(kOrgans)) GTEST_SKIP() << "the corpus is not beside this checkout: " << kOrgans;
  for (std::size_t n = 0; n < std::min(std::size(kSurfaces), kOrgansTried); ++n) {
    const Organ& organ = kSurfaces[n];
    SCOPED_TRACE(organ.node);
    Box box;
    const MeshData mesh = mesh_of(organ, box);
    ASSERT_FALSE(mesh.index.empty());
    const double size = static_cast<double>(box.diagonal());
    // A finger pressed through a thin wall is on its other side.
    const Primitive primitive{.position = mesh.position, .index = mesh.index};
    const Result<BuiltMesh> built = build_mesh(organ.node, {&primitive, 1}, mat4(1.0f));
    ASSERT_TRUE(built.ok());
    const double thickness = measure_shape(built->mesh).thickness;
    const double depth = std::min(0.02 * size, thickness > 0.0 ? 0.3 * thickness : size);
    Scene scene;
    scene.add_surface("organ", mesh);
    add_finger(scene, 0.01 * size, topmost(mesh), 0.03 * size);
    Result<Session> session = Session::open(scene);
    ASSERT_TRUE(session) << session.error().message();
    const double most = press(*session, organ, topmost(mesh), depth - 0.01 * size, 0.03 * size);
    EXPECT_GT(most, 0.0) << "it was never touched";
    EXPECT_LE(most, kMostForce * (1.0 + 1e-9));
    const Result<Reading> after = session->reading("finger");
    EXPECT_LT(length(after->force), 1e-3) << "the finger has left it";
    std::cout << "  " << organ.node << ": " << mesh.index.size() / 3 << " triangles, " << most << " N, p99 "
              << session->figures().p99_us << " us a tick\n";
  }
}

TEST(Organs, AsTissueTheyAreFilledWithinTheBudgetAndComeToRest) {
  if (!fs::exists(kOrgans)) GTEST_SKIP() << "the corpus is not beside this checkout: " << kOrgans;
  for (std::size_t n = 0; n < std::min(std::size(kTissues), kOrgansTried); ++n) {
    const Organ& organ = kTissues[n];
    SCOPED_TRACE(organ.node);
    Box box;
    const MeshData mesh = mesh_of(organ, box);
    ASSERT_FALSE(mesh.index.empty());
    const double size = static_cast<double>(box.diagonal());
    SoftBodyParameters tissue{.young = 5e3};
    tissue.rayleigh = {5.0, 0.005};
    tissue.pinned = {box.min - 1.0f, vec3(box.max.x + 1.0f, box.min.y + 0.2f * box.size().y, box.max.z + 1.0f)};

    const Primitive primitive{.position = mesh.position, .index = mesh.index};
    const Result<BuiltMesh> built = build_mesh(organ.node, {&primitive, 1}, mat4(1.0f));
    ASSERT_TRUE(built.ok());
    SoftBody body;
    static_cast<SoftBodyParameters&>(body) = tissue;
    const std::uint64_t begin = now_ns();
    const Result<SoftPreview> preview = preview_soft_body(*built, body);
    ASSERT_TRUE(preview) << preview.error().message();
    const double filled_ms = ms_since(begin);
    EXPECT_LE(preview->tetrahedra, kMostUsualTets);
    EXPECT_GT(preview->tetrahedra, kUsualTets / 4);
    EXPECT_EQ(preview->parts, 1u);
    EXPECT_GT(preview->quality.smallest_dihedral, 0.1) << "[rad] flat elements";
    EXPECT_GT(preview->quality.worst_ratio, 0.02);

    Scene scene;
    scene.simulation().gravity = {0, 0, 0};
    scene.add_soft_body("organ", mesh, tissue);
    add_finger(scene, 0.03 * size, topmost(mesh), 0.05 * size);
    Result<Session> session = Session::open(scene);
    ASSERT_TRUE(session) << session.error().message();
    std::vector<vec3> rest, now;
    ASSERT_TRUE(session->vertices("organ", rest));
    const std::uint64_t start = now_ns();
    const double most = press(*session, organ, topmost(mesh), 0.0, 0.05 * size);  // the finger's radius deep
    EXPECT_GT(most, 0.0) << "it was never touched";
    EXPECT_LE(most, kMostForce * (1.0 + 1e-9));
    ASSERT_TRUE(session->step(kDown));
    ASSERT_TRUE(session->vertices("organ", now));
    ASSERT_EQ(now.size(), rest.size());
    double moved = 0.0;
    for (std::size_t v = 0; v < now.size(); ++v) {
      const double away = static_cast<double>(length(now[v] - rest[v]));
      ASSERT_TRUE(std::isfinite(away));
      moved = std::max(moved, away);
    }
    EXPECT_LT(moved, 0.03 * size) << "nothing holds it down any more";
    const double steps = static_cast<double>(session->figures().soft_steps);
    std::cout << "  " << organ.node << ": " << preview->tetrahedra << " tetrahedra in " << filled_ms << " ms, "
              << preview->quality.worst_ratio << " 3 r/R at worst, " << most << " N, " << moved / size
              << " of its size from rest, " << ms_since(start) / steps << " ms a step (" << preview->step_ms
              << " said)\n";
  }
}

}  // namespace
}  // namespace pliant
