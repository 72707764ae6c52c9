// Worlds made by hand for looking at: small enough to know where everything must appear.
#pragma once

#include <functional>
#include <memory>

#include "components/soft_body.h"
#include "components/world.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/renderer.h"

namespace pliant::test {

// One context for the whole program (drivers start slowly); null where this machine has none.
HeadlessContext* context();

// Of low quality: surfaces alone, without what is near them. Null, and the test has failed, where it cannot be made.
std::unique_ptr<Renderer> renderer_for(const World& world);

// A flat sheet of (2 n) x n squares, [-1, 1] x [-0.5, 0.5] m in the plane y = 0, facing up.
World sheet(std::uint32_t n);
// A sphere of radius 1 m about the origin, of rows x 2 rows facets.
World sphere(std::uint32_t rows);
// A probe at `position`, in the colour red; returns it.
Entity add_probe(World& world, dvec3 position, double radius = 0.0);

// A cube of soft matter, 1 m wide, standing on y = 0 with its middle over the origin, of n x n squares a face; inside,
// 2 x 2 x 2 cells of six tetrahedra.
World soft_block(std::uint32_t n);
// Its collision mesh and nodes after every point p has moved to `where(p)`.
using Where = std::function<vec3(vec3 rest)>;
SoftSnapshot soft_snapshot_of(const World& world, const Where& where);

// The only deformable of such a world, and its mesh.
Entity object_of(const World& world);
const Mesh& mesh_of(const World& world);

// All zones of the object, with the stream that `stream(position, normal)` gives each vertex.
using StreamAt = std::function<vec4(vec3 position, vec3 normal)>;
Snapshot snapshot_of(const World& world, const StreamAt& stream);
// The same, but only the zones in which some vertex is not at rest.
Snapshot awake_only(const World& world, Snapshot snapshot);

// A dent of depth `depth` [m] and radius `reach` [m] about `center`, with a rim that keeps the volume
// (methods.md 1.3, p = 3), and the normal correction that belongs to it (1.4).
StreamAt dent(vec3 center, float depth, float reach);

}  // namespace pliant::test

// First line of a test that draws: skips it, with a sentence, where nothing can.
#define NEEDS_A_CONTEXT()       \
  if (!pliant::test::context()) \
  GTEST_SKIP() << "there is no OpenGL 4.5 context here; install libegl-mesa0, libgl1-mesa-dri"
