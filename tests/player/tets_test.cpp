// inspect and convert on tetrahedra.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class Tets : public CommandTest {};

const char* const kOne =
    "# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 0.1 0 0 0 0.1 0 0 0 0.1 "
    "9 9 9\nCELLS 1 5\n4 0 2 1 3\nCELL_TYPES 1\n10\n";

TEST_F(Tets, InspectSaysOfAFileWhatItHoldsAndWhatWasMended) {
  write_text(folder / "one.vtk", kOne);
  const Said said = pliant({"inspect", "one.vtk", "--json"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = Json::parse(said.out);
  EXPECT_EQ(json["nodes"], 4);
  EXPECT_EQ(json["tetrahedra"], 1);
  EXPECT_EQ(json["boundary_triangles"], 4);
  EXPECT_EQ(json["parts"], 1);
  EXPECT_NEAR(json["volume_m3"], 1e-3 / 6.0, 1e-12);
  EXPECT_NEAR(json["largest_dihedral_deg"], 90.0, 1e-9);
  EXPECT_EQ(json["notes"].size(), 2u) << json["notes"];
  EXPECT_NE(pliant({"inspect", "one.vtk"}).out.find("1 tetrahedra"), std::string::npos);
  write_text(folder / "cut.vtk", std::string(kOne).substr(0, 145));
  expect_refused({"inspect", "cut.vtk"}, 1, "cut.vtk");
}

TEST_F(Tets, ARunSaysWhatWasMendedOfTheFileThatItsLevelNames) {
  write_text(folder / "one.vtk", kOne);
  write_text(folder / "level.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "extensionsUsed": ["PLIANT_soft_body"],
      "nodes": [{"name": "tissue", "extensions": {"PLIANT_soft_body": {"mesh": "one.vtk"}}}]})");
  const Said said = pliant({"run", "level.gltf", "--seconds", "0.05", "--frames", "0", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* note : {"one.vtk: 1 inverted tetrahedron", "one.vtk: 1 node that no tetrahedron names"}) {
    EXPECT_NE(said.err.find("pliant: note: " + std::string(note)), std::string::npos) << said.err;
    EXPECT_NE(report("out")["notes"].dump().find(note), std::string::npos) << report("out")["notes"];
  }
}

TEST_F(Tets, ConvertMakesTheBoundaryAMesh) {
  write_text(folder / "one.vtk", kOne);
  const Said said = pliant({"convert", "one.vtk", "one.glb"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = Json::parse(pliant({"inspect", "one.glb", "--json"}).out);
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["objects"][0]["closed"], true);
  EXPECT_TRUE(json["tissue"].empty());
}

}  // namespace
}  // namespace pliant::testing
