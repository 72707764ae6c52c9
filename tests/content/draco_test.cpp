// Draco blobs damaged byte by byte, and the import of bare .drc files.
#include <gtest/gtest.h>

#include <random>

#include "content/files/mesh_import.h"
#include "content/gltf/form/gltf_draco.h"

namespace pliant::test {
namespace {

DracoMesh grid(std::uint32_t n) {
  DracoMesh mesh;
  DracoAttribute position{"POSITION", 0, 3, false, {}};
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const float x = static_cast<float>(i), y = static_cast<float>(j);
      position.values.insert(position.values.end(), {x, y, 0.1f * x * y});
      if (i + 1 < n && j + 1 < n) {
        const std::uint32_t a = j * n + i;
        mesh.index.insert(mesh.index.end(), {a, a + 1, a + n, a + 1, a + n + 1, a + n});
      }
    }
  mesh.vertices = n * n;
  mesh.attributes.push_back(position);
  return mesh;
}

TEST(Draco, ABareFileReadsBackWithItsTriangles) {
  DracoMesh mesh = grid(9);
  const Result<Bytes> blob = encode_draco(mesh, 20);
  ASSERT_TRUE(blob.ok());
  const Result<Level> level = import_draco(*blob, "grid");
  ASSERT_TRUE(level.ok()) << level.error().message();
  const Primitive& primitive = level->meshes[0].primitives[0];
  EXPECT_EQ(primitive.index.size(), 8u * 8 * 2 * 3);
  float area = 0.0f;
  for (std::size_t t = 0; t < primitive.index.size(); t += 3) {
    const vec3 a = primitive.position[primitive.index[t]], b = primitive.position[primitive.index[t + 1]],
               c = primitive.position[primitive.index[t + 2]];
    area += 0.5f * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));  // of the projection onto z = 0
  }
  EXPECT_NEAR(area, 64.0f, 1e-3f);
}

TEST(Draco, DamagedBlobsAreDecodedOrRefusedAndIndicesStayInside) {
  DracoMesh mesh = grid(6);
  const Result<Bytes> blob = encode_draco(mesh, 12);
  ASSERT_TRUE(blob.ok());
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Bytes damaged = *blob;
    for (int k = 0; k < 1 + trial % 4; ++k)
      damaged[5 + random() % (damaged.size() - 5)] = static_cast<std::uint8_t>(random());
    if (trial % 3 == 0) damaged.resize(random() % damaged.size());
    const Result<DracoMesh> decoded = decode_draco(damaged, {0});
    if (!decoded) {
      ++refused;
      continue;
    }
    for (const std::uint32_t index : decoded->index) ASSERT_LT(index, decoded->vertices);
    ASSERT_EQ(decoded->attributes[0].values.size(), decoded->vertices * decoded->attributes[0].width);
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace pliant::test
