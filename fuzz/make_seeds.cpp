// Writes the committed seeds with the project's own writers: small files that exercise every branch of a reader.
// make_seeds FOLDER
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "content/files/file_io.h"
#include "content/files/image.h"
#include "content/gltf/form/gltf_draco.h"
#include "content/level_file.h"

namespace {

using namespace pliant;
namespace fs = std::filesystem;

Status write_text(const fs::path& path, const std::string& text) {
  return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// A tetrahedron with every attribute, a textured material, a probe with a device, a light and a camera.
Level small_level() {
  Level level;
  level.images.push_back({"checker", 2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 9}});
  Material material;
  material.base_color_texture = 0;
  material.ior = 1.4f;
  material.transmission = 0.1f;
  material.thickness = 0.01f;
  level.materials.push_back(material);
  Primitive p;
  p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  p.normal = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  p.tangent = {{1, 0, 0, 1}, {0, 1, 0, -1}, {0, 0, 1, 1}, {1, 0, 0, 1}};
  p.uv = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  p.stiffness = {1, 2, 3, 4};
  p.friction = {1, 0, 1, 0};
  p.index = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  p.material = 0;
  level.meshes.push_back({"tetrahedron", {p}});
  level.nodes.resize(4);
  level.nodes[0].name = "thing";
  level.nodes[0].mesh = 0;
  level.nodes[0].children = {1};
  level.nodes[0].local.rotation = quat(0.6f, 0.8f, 0, 0);
  level.nodes[0].deformable = Deformable{};
  level.nodes[0].deformable->stiffness = 100.0;
  level.nodes[1].name = "probe";
  level.nodes[1].parent = 0;
  level.nodes[1].probe = Probe{};
  level.nodes[1].probe_device = "hand";
  level.nodes[2].name = "hand";
  level.nodes[2].device = HapticDevice{};
  level.nodes[2].device->driver = DriverKind::kOrbit;
  level.nodes[2].light = Light{};
  level.nodes[3].name = "eye";
  level.nodes[3].camera = Camera{};
  level.environment = LevelEnvironment{"sky.exr", 1.0, 0.5};
  return level;
}

void write_panorama(const fs::path& path, Imf::Compression compression) {
  std::vector<float> values;
  for (int i = 0; i < 16 * 8; ++i) values.push_back(0.1f * static_cast<float>(i % 7));
  Imf::Header header(16, 8);
  header.compression() = compression;
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 64));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(8);
}

template <class... T>
void append(std::string& out, T... values) {
  (out.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

// One tetrahedron in each form.
bool write_tets(const fs::path& folder) {
  bool good = write_text(folder / "msh2",
                         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
                         "$EndNodes\n$Elements\n2\n1 2 2 0 1 1 2 3\n2 4 2 0 1 1 2 3 4\n$EndElements\n")
                  .ok();
  good = good && write_text(folder / "msh4",
                            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n"
                            "1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n");
  std::string binary = "$MeshFormat\n4.1 1 8\n";
  append(binary, std::int32_t{1});
  binary += "\n$EndMeshFormat\n$Nodes\n";
  append(binary, std::uint64_t{1}, std::uint64_t{4}, std::uint64_t{1}, std::uint64_t{4});
  append(binary, std::int32_t{3}, std::int32_t{1}, std::int32_t{0}, std::uint64_t{4});
  append(binary, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}, std::uint64_t{4});
  append(binary, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  binary += "\n$EndNodes\n$Elements\n";
  append(binary, std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{1});
  append(binary, std::int32_t{3}, std::int32_t{1}, std::int32_t{4}, std::uint64_t{1});
  append(binary, std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}, std::uint64_t{4});
  good = good && write_text(folder / "msh4_binary", binary + "\n$EndElements\n");
  const std::string points = "DATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
  good = good && write_text(folder / "vtk", "# vtk DataFile Version 3.0\none\nASCII\n" + points +
                                                "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
  good = good && write_text(folder / "vtk5", "# vtk DataFile Version 5.1\none\nASCII\n" + points +
                                                 "CELLS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n"
                                                 "0 1 2 3\nCELL_TYPES 1\n10\n");
  return good &&
         write_text(folder / "tetgen", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\0011 4 0\n1 1 2 3 4\n").ok();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "make_seeds FOLDER\n"), 2;
  const fs::path folder = arguments[1];
  for (const char* name : {"gltf", "draco", "exr", "image", "mesh", "tets"}) fs::create_directories(folder / name);
  const Level level = small_level();
  const Primitive& p = level.meshes[0].primitives[0];
  DracoMesh mesh{4, p.index, {{"POSITION", 0, 3, false, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}}}};
  const Result<Bytes> blob = encode_draco(mesh, 10);
  bool good =
      save_level(level, folder / "gltf/plain.glb").ok() && save_level(level, folder / "gltf/draco.glb", {12}).ok();
  good = good && blob && write_file(folder / "draco/tetrahedron", *blob);
  good = good && write_file(folder / "image/checker", encode_png(2, 2, level.images[0].rgba.data()));
  good =
      good && write_text(folder / "mesh/obj",
                         std::string(1, '\0') + "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n");
  good =
      good &&
      write_text(folder / "mesh/ply",
                 "\1ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  good = good && write_text(folder / "mesh/off", "\2OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  good = good && write_text(folder / "mesh/stl",
                            "\3solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                            "0\nendloop\nendfacet\nendsolid t\n");
  write_panorama(folder / "exr/zip", Imf::ZIP_COMPRESSION);
  write_panorama(folder / "exr/piz", Imf::PIZ_COMPRESSION);
  write_panorama(folder / "exr/dwaa", Imf::DWAA_COMPRESSION);
  good = good && write_tets(folder / "tets");
  return good ? 0 : 1;
}
