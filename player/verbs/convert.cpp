// pliant convert: any mesh format to glTF or GLB; an EXR panorama to a picture of its cube map.
#include <set>
#include <string>
#include <utility>

#include "content/files/exr.h"
#include "content/files/file_io.h"
#include "content/files/image.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "content/validate.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/files/left_behind.h"
#include "player/verbs/panorama_preview.h"
#include "player/verbs/verbs.h"
#include "systems/prepare_world.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kPreviewFace = 256;  // [pixel] side of a cube face

constexpr InterruptWords kWords{"the file is being written; press Ctrl-C again to quit at once without it",
                                "quit at once; the file was not written"};

// Registers the temporary files of `file`, and of the .bin of a .gltf, for removal.
void remove_if_forced(const Interrupt& interrupt, const fs::path& file) {
  std::error_code ignored;
  for (const fs::path& each : {file, fs::path(file).replace_extension(".bin")})
    if (const fs::path aside = aside_of(each); !fs::exists(fs::symlink_status(aside, ignored)))
      interrupt.remove_if_forced(aside);
}

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// The drawn half of a built mesh as primitives: welded, without degenerate triangles, in spatial order.
LevelMesh from_built(const BuiltMesh& built, const LevelMesh& source) {
  LevelMesh mesh{source.name, {}};
  constexpr std::uint32_t kUnused = 0xffffffffu;
  for (const DrawPart& part : built.draw.parts) {
    Primitive out;
    out.material = part.material;
    std::vector<std::uint32_t> number(built.draw.vertices.size(), kUnused);
    for (std::uint32_t i = part.first_index; i < part.first_index + part.index_count; ++i) {
      const std::uint32_t old = built.draw.indices[i];
      if (number[old] == kUnused) {
        number[old] = static_cast<std::uint32_t>(out.position.size());
        const DrawVertex& v = built.draw.vertices[old];
        out.position.push_back(v.position);
        out.normal.push_back(v.normal);
        out.tangent.push_back(v.tangent);
        out.uv.push_back(v.uv);
        if (!built.mesh.stiffness_factor.empty()) out.stiffness.push_back(built.mesh.stiffness_factor[v.touch_vertex]);
        if (!built.mesh.friction_factor.empty()) out.friction.push_back(built.mesh.friction_factor[v.touch_vertex]);
        if (!built.mesh.damping_factor.empty()) out.damping.push_back(built.mesh.damping_factor[v.touch_vertex]);
        if (!built.mesh.relaxation_factor.empty())
          out.relaxation.push_back(built.mesh.relaxation_factor[v.touch_vertex]);
        if (!built.pinned.empty()) out.pinned.push_back(built.pinned[v.touch_vertex]);
        if (!built.handle.empty()) out.handle.push_back(built.handle[v.touch_vertex]);
      }
      out.index.push_back(number[old]);
    }
    if (!out.index.empty()) mesh.primitives.push_back(std::move(out));
  }
  return mesh;
}

Status reorder(Level& level) {
  level.source.reset();  // the source document has the meshes in their old order
  // A mesh that is only drawn keeps its winding: a room is seen from inside.
  std::set<std::ptrdiff_t> touched;
  const bool bare = !level.has_pliant();
  for (const LevelNode& node : level.nodes)
    if (bare || node.deformable || node.rigid_body || node.soft_body) touched.insert(node.mesh);
  for (LevelMesh& mesh : level.meshes) {
    if (mesh.primitives.empty()) continue;
    MeshOptions as_touched;
    as_touched.mend_winding = touched.count(&mesh - level.meshes.data()) != 0;
    auto built = build_mesh(mesh.name, mesh.primitives, mat4(1), as_touched);
    if (!built) return built.error();
    mesh = from_built(*built, mesh);
  }
  return Done{};
}

Existing existing(const ConvertOptions& options) {
  return options.force ? Existing::kReplace : Existing::kRefuse;
}

// Removes references to missing files. They may be copied beside the new level later, as a note says (left_behind.h).
void leave_out_missing_files(Level& level) {
  const fs::path folder = level.path.parent_path();
  const auto is_missing = [&](const std::string& name) {
    std::error_code ignored;
    const Result<fs::path> file = confined_path(folder, name);
    return !name.empty() && !fs::exists(file ? *file : folder / name, ignored);
  };
  if (level.environment && is_missing(level.environment->panorama)) level.environment->panorama.clear();
  for (LevelNode& node : level.nodes) {
    if (node.device && is_missing(node.device->file))
      node.device->driver = DriverKind::kNull, node.device->file.clear();
    if (node.motion && is_missing(node.motion->script)) node.motion.reset();
    if (node.effect && is_missing(node.effect->path)) node.effect.reset();
    if (node.soft_body && is_missing(node.soft_body->mesh)) {
      node.soft_body.reset();
      if (!node.rigid_body) node.handle.reset();
    }
  }
}

// Refuses to write a level that `validate` would reject.
Status check_valid(Level level, const std::string& in) {
  leave_out_missing_files(level);
  for (const Finding& finding : validate_level(std::move(level), prepare_world))
    if (finding.severity == Severity::kError)
      return Error{in + (finding.pointer.empty() ? "" : " " + finding.pointer), finding.what,
                   (finding.cure.empty() ? "correct it first" : finding.cure) +
                       " (nothing is written that `pliant validate` would refuse)",
                   finding.code};
  return Done{};
}

// Checks the output before the work, not after it.
Status check_free(const ConvertOptions& options) {
  std::error_code ignored;
  if (options.force || !fs::exists(fs::symlink_status(options.out, ignored))) return Done{};
  return Error{options.out, "is there already", "name another, or replace it with --force"};
}

int convert_panorama(const ConvertOptions& options) {
  if (lower_extension(options.out) != ".png")
    return fail(kUsage, {options.out, "a panorama becomes a picture of its cube map", "end the name with .png"});
  for (const auto& [given, name] : {std::pair(options.draco_bits != 0, "--draco"),
                                    {options.reorder, "--reorder"},
                                    {options.unit.has_value(), "--unit"}})
    if (given) return fail(kUsage, {name, "is for meshes, and a panorama becomes a picture", "leave it out"});
  if (const Status free = check_free(options); !free) return fail(kFailed, free.error());
  const auto panorama = load_panorama(options.in);
  if (!panorama) return fail(kFailed, panorama.error());
  const Interrupt interrupt(kWords);  // until the file is in place: removes temporary files on interruption
  remove_if_forced(interrupt, options.out);
  const Image image = cube_cross(*panorama, kPreviewFace);
  if (const Status s =
          write_file(options.out, encode_png(image.width, image.height, image.rgba.data()), existing(options));
      !s)
    return fail(kFailed, s.error());
  print("{}: {} x {} pixels, a cross of six faces of {}\n", options.out, image.width, image.height, kPreviewFace);
  return kDone;
}

}  // namespace

int convert(const ConvertOptions& options) {
  if (lower_extension(options.in) == ".exr") return convert_panorama(options);
  const std::string extension = lower_extension(options.out);
  if (extension != ".gltf" && extension != ".glb")
    return fail(kUsage, {options.out, "meshes are written as glTF", "end the name with .glb or .gltf"});
  if (const Status free = check_free(options); !free) return fail(kFailed, free.error());
  auto level = load_level(options.in);
  if (!level) return fail(kFailed, level.error());
  if (const Status unit = check_unit(*level, options.unit); !unit) return fail(kUsage, unit.error());
  for (const std::string& sentence : level->notes) note(sentence);
  scale_roots(*level, options.unit.value_or(1.0));
  if (options.reorder)
    if (const Status s = reorder(*level); !s) return fail(kFailed, s.error());
  if (const Status s = check_valid(*level, options.in); !s) return fail(kFailed, s.error());
  const Interrupt interrupt(kWords);  // until the file is in place: removes temporary files on interruption
  remove_if_forced(interrupt, options.out);
  if (const Status s =
          save_level(*level, options.out, SaveOptions{options.draco_bits, options.no_draco, existing(options)});
      !s)
    return fail(kFailed, s.error());

  say_left_behind(*level, options.out);
  std::size_t triangles = 0;
  for (const LevelMesh& mesh : level->meshes)
    for (const Primitive& primitive : mesh.primitives) triangles += primitive.index.size() / 3;
  std::error_code ignored;
  print("{}: {} meshes, {} triangles, {} bytes\n", options.out, level->meshes.size(), triangles,
        fs::file_size(options.out, ignored));
  return kDone;
}

}  // namespace pliant
