// Soft bodies kept for other runs: the same bytes come back, whatever goes into a body has its own, and room is kept.
#include "content/level/soft_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <set>

#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {
namespace fs = std::filesystem;

LevelMesh ball_mesh() {
  Primitive ball = test::icosphere(2);
  for (vec3& p : ball.position) p *= 0.1f;
  return {"ball", {ball}};
}

class SoftStoreTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("pliant-soft-store-" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder / "bodies");
    node.name = "ball";
    node.soft_body = SoftBody{};
    node.soft_body->cell = 0.03;
  }
  void TearDown() override { fs::remove_all(folder); }
  SoftParts made() const {
    auto parts = make_soft_parts(node, &ball, mat4(1.0f), folder);
    EXPECT_TRUE(parts.ok()) << parts.error().message();
    return std::move(*parts);
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder / "bodies"), fs::directory_iterator()));
  }

  fs::path folder;
  LevelNode node;
  LevelMesh ball = ball_mesh();
};

TEST_F(SoftStoreTest, WhatWasKeptComesBackWholeOrNotAtAll) {
  const SoftParts parts = made();
  const SoftStore store(folder / "bodies");
  EXPECT_FALSE(store.find(7));
  store.keep(7, parts);
  const std::optional<SoftParts> found = store.find(7);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->tets.nodes, parts.tets.nodes);
  EXPECT_EQ(found->tets.tets, parts.tets.tets);
  EXPECT_EQ(found->tets.report.findings, parts.tets.report.findings);
  EXPECT_EQ(found->tets.report.notes, parts.tets.report.notes);
  EXPECT_EQ(found->surface.mesh.triangles, parts.surface.mesh.triangles);
  EXPECT_EQ(found->surface.mesh.tree.levels.size(), parts.surface.mesh.tree.levels.size());
  EXPECT_EQ(found->surface.draw.indices, parts.surface.draw.indices);
  EXPECT_EQ(found->tets.embedding.size(), parts.surface.mesh.vertex_count);
  const std::vector<std::uint8_t> bytes = bytes_of(parts);
  EXPECT_EQ(bytes_of(*found).size(), bytes.size());
  for (std::size_t cut = 0; cut < bytes.size(); cut += 997)
    EXPECT_FALSE(soft_parts_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut)})) << cut;
}

TEST_F(SoftStoreTest, EverythingThatGoesIntoABodyMakesAnotherAndNothingElse) {
  std::set<std::uint64_t> keys;
  const auto key = [&] { return soft_key(node, &ball, mat4(1.0f), folder); };
  const auto is_new = [&] { return keys.insert(key()).second; };
  EXPECT_TRUE(is_new());
  SoftBody& body = *node.soft_body;
  const std::vector<std::function<void()>> goes_in{
      [&] { node.name = "other"; },
      [&] { body.cell = 0.02; },
      [&] { body.fill = Fill::kWall; },
      [&] { body.thickness = 0.01; },
      [&] {
        body.focus = Box{vec3(0), vec3(1)};
      },
      [&] {
        body.pinned = Box{vec3(0), vec3(1)};
      },
      [&] { node.handle = Handle6{}; },
      [&] {
        node.handle->box = Box{vec3(0), vec3(1)};
      },
      [&] { ball.primitives[0].position[3].x += 1e-6f; },
      [&] { ball.primitives[0].pinned.assign(ball.primitives[0].position.size(), 1.0f); },
      [&] { ball.primitives.push_back(ball.primitives[0]); },
      [&] { body.mesh = "tissue.msh"; },
      [&] { std::ofstream(folder / "tissue.msh") << "a"; },
      [&] { std::ofstream(folder / "tissue.msh") << "b"; },
  };
  for (std::size_t i = 0; i < goes_in.size(); ++i) {
    goes_in[i]();
    EXPECT_TRUE(is_new()) << i;
  }
  EXPECT_TRUE(keys.insert(soft_key(node, nullptr, mat4(1.0f), folder)).second);
  EXPECT_TRUE(keys.insert(soft_key(node, &ball, mat4(2.0f), folder)).second);
  const std::uint64_t last = key();
  body.young = 1e4, body.poisson = 0.3, body.density = 900, body.rayleigh = {1, 1}, body.friction_static = 0.1;
  body.solver = SolverKind::kDense, body.under_gravity = UnderGravity::kModelled, body.carries = Carries::kInside;
  node.handle->translation = {1, 1}, node.handle->device = "other";
  EXPECT_EQ(key(), last);
}

TEST_F(SoftStoreTest, ABodyIsTheSameWithoutWhatItsKeyLeavesOut) {
  node.soft_body->young = 123, node.soft_body->poisson = 0.2, node.soft_body->carries = Carries::kInside;
  node.handle = Handle6{};
  node.handle->box = Box{vec3(0.05f, -0.2f, -0.2f), vec3(0.2f)};
  const SoftParts parts = made();
  const auto only = make_soft_parts(only_tissue(node), &ball, mat4(1.0f), folder);
  ASSERT_TRUE(only.ok());
  EXPECT_EQ(only->tets.nodes, parts.tets.nodes);
  EXPECT_EQ(only->tets.tets, parts.tets.tets);
  EXPECT_EQ(only->tets.handle_count, parts.tets.handle_count);
  EXPECT_GT(only->tets.handle_count, 0u);
}

TEST_F(SoftStoreTest, TheBodyUsedLongestAgoMakesRoom) {
  const SoftParts parts = made();
  const std::size_t size = bytes_of(parts).size();
  const SoftStore store(folder / "bodies", 2 * size + size / 2);
  const auto used = [&](std::uint64_t key, int ago) {  // [s]
    fs::last_write_time(folder / "bodies" / (std::string(15, '0') + std::to_string(key) + ".body"),
                        fs::file_time_type::clock::now() - std::chrono::seconds(ago));
  };
  store.keep(1, parts);
  store.keep(2, parts);
  used(1, 20), used(2, 10);
  ASSERT_TRUE(store.find(1));  // is used now
  store.keep(3, parts);
  EXPECT_TRUE(store.find(1));
  EXPECT_FALSE(store.find(2));
  EXPECT_TRUE(store.find(3));
  SoftStore(folder / "bodies", size - 1).keep(4, parts);
  EXPECT_FALSE(store.find(4)) << "larger than all the room";
  EXPECT_EQ(files(), 2u);
}

}  // namespace
}  // namespace pliant
