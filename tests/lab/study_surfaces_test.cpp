// The study `surfaces` against closed forms: of the surfaces themselves, and of facets on a sphere.
#include "lab/study/surfaces/study_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/study/surfaces/corrected_normals.h"
#include "lab/study/surfaces/singular_surfaces.h"

namespace pliant {
namespace {

TEST(StudySurfaces, LoopsAreClosedOnTheirSurfaceAndTheirNormalsStandOnIt) {
  for (const SmoothSurface& surface : {smooth_sphere(), smooth_torus(), smooth_saddle()}) {
    EXPECT_LT(length(surface.loop(0).p - surface.loop(1).p), 1e-12) << surface.name;
    const Mesh mesh = surface.mesh(5000);
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 5000, 250) << surface.name;
    for (double s = 0; s < 1; s += 0.01) {
      const dvec3 along = normalize(surface.loop(s + 1e-6).p - surface.loop(s - 1e-6).p);
      EXPECT_LT(std::abs(dot(along, surface.loop(s).n)), 1e-6) << surface.name << ' ' << s;
      EXPECT_NEAR(length(surface.loop(s).n), 1, 1e-12);
    }
  }
}

TEST(StudySurfaces, AMeshFacesTheWayThatItsSurfaceDoes) {
  for (const SmoothSurface& surface : {smooth_sphere(), smooth_torus(), smooth_saddle()}) {
    const FeltErrors errors = feel(surface.mesh(5000), surface, FeltSurface::kVirtualVertex, 200);
    EXPECT_LT(errors.turned, 20) << surface.name;
  }
}

// A facet of a circle of radius R, seen from the depth d behind it, ends at the angle e / (2 (R - d)) from its centre.
TEST(StudySurfaces, FacetsTurnTheForceByHalfAnEdgeOverTheRadius) {
  const SmoothSurface sphere = smooth_sphere();
  const Mesh mesh = sphere.mesh(5000);
  const FeltErrors errors = feel(mesh, sphere, FeltSurface::kFacets, 20'000);
  const double edge = mesh.mean_edge, want = edge / 2 / 0.1 * 180 / M_PI;
  EXPECT_GT(errors.turned, 0.5 * want);
  EXPECT_LT(errors.turned, 2.0 * want);
}

// The work of a conservative surface is below the resolution of the sampled sum; that of another is above it.
TEST(StudySurfaces, FacetsAndPatchesAreConservativeAndInterpolatedNormalsAreNot) {
  const SmoothSurface torus = smooth_torus();
  const Mesh mesh = torus.mesh(5000);
  const FeltErrors facets = feel(mesh, torus, FeltSurface::kFacets, 20'000);
  EXPECT_LT(facets.work, 3 * facets.floor);
  EXPECT_LT(facets.work, 3e-4);
  EXPECT_LT(feel(mesh, torus, FeltSurface::kPatches, 20'000).work, 1e-4);
  for (const FeltSurface felt : {FeltSurface::kShading, FeltSurface::kVirtualVertex}) {
    const FeltErrors errors = feel(mesh, torus, felt, 20'000);
    EXPECT_GT(errors.work, 1e-2) << name_of(felt);
    EXPECT_LT(errors.floor, 0.05 * errors.work) << name_of(felt);
  }
}

TEST(StudySurfaces, PatchesGainMoreThanFacetsWhenTheMeshGetsFiner) {
  const SmoothSurface sphere = smooth_sphere();
  const Mesh coarse = sphere.mesh(5000), fine = sphere.mesh(20'000);
  const auto gain = [&](FeltSurface felt) {
    return feel(coarse, sphere, felt, 5000).ripple / feel(fine, sphere, felt, 5000).ripple;
  };
  EXPECT_NEAR(gain(FeltSurface::kFacets), 4, 1.5);  // half the edge, a quarter of the sagitta
  EXPECT_GT(gain(FeltSurface::kPatches), 8);
}

TEST(StudySurfaces, CorrectedNormalsAreExactOnASheetAndThoseOfTrianglesBecomeSo) {
  for (const double depth : {0.02, 0.1, 0.3}) {
    EXPECT_LT(normals_on({false, 8, depth}, DrawnNormal::kCorrected, 1).worst, 1e-3) << depth;
    const double coarse = normals_on({false, 8, depth}, DrawnNormal::kRecomputed, 1).rms;
    EXPECT_NEAR(coarse / normals_on({false, 16, depth}, DrawnNormal::kRecomputed, 1).rms, 4, 1.2) << depth;
  }
  // Without a dent's slope a sphere's normals at rest are exact; the correction is to first order in the curvature.
  const double rest = normals_on({true, 16, 0.02}, DrawnNormal::kRest, 1).rms;
  EXPECT_LT(normals_on({true, 16, 0.02}, DrawnNormal::kCorrected, 1).rms, 0.05 * rest);
}

TEST(StudySurfaces, FeetAroundAnEdgeGiveNoWorkAndDriftingNormalsDo) {
  const CreaseErrors feet = feel_creases(8, CreaseFelt::kFeet, 4000),
                     drift = feel_creases(8, CreaseFelt::kDriftingNormals, 4000);
  EXPECT_LT(feet.work, 0.02);
  EXPECT_LT(feet.direction, 0.01);
  EXPECT_GT(drift.work, 5 * feet.work);
  EXPECT_GT(drift.direction, 1);
}

TEST(StudySurfaces, ErrorsRepeatToTheBit) {
  const SmoothSurface saddle = smooth_saddle();
  for (const FeltSurface felt : kFeltSurfaces) {
    const FeltErrors one = feel(saddle.mesh(5000), saddle, felt, 500), two = feel(saddle.mesh(5000), saddle, felt, 500);
    EXPECT_EQ(one.ripple, two.ripple);
    EXPECT_EQ(one.direction, two.direction);
    EXPECT_EQ(one.work, two.work);
  }
}

}  // namespace
}  // namespace pliant
