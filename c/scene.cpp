// Scenes: loaded from files and memory, or built by calls.
#include "c/scene.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "pliant/content.h"

using namespace pliant::c;
namespace fs = std::filesystem;

namespace pliant::c {

OpenProgress progress_of_c(pliant_progress progress, void* user) {
  if (!progress) return {};
  return [progress, user](double share, const std::string& doing) { return progress(user, share, doing.c_str()) == 0; };
}

std::string without(std::string text, const std::string& folder) {
  for (std::size_t at; !folder.empty() && (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
  return text;
}

Error without(Error error, const std::string& folder) {
  for (std::string* const part : {&error.where, &error.what, &error.cure}) *part = without(std::move(*part), folder);
  return error;
}

}  // namespace pliant::c

namespace {

// A folder of its own in the system's folder for temporary files.
struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / ("pliant-" + std::string(6, 'X'))).string();
    if (!mkdtemp(name.data()))
      throw pliant::Error{name, "cannot be made", "set TMPDIR to a folder that can be written", "file.unwritable"};
    path = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

std::unique_ptr<SceneHandle> loaded(const fs::path& path, const pliant_load_options* options) {
  pliant::SafetyCap cap;
  pliant::OpenProgress progress;
  if (options) {
    sized(options, "options");
    if (at_least_zero(options->max_force, "options->max_force") > 0.0) cap.max_force = options->max_force;
    progress = progress_of_c(options->progress, options->user);
  }
  auto handle = std::make_unique<SceneHandle>();
  handle->scene = taken(pliant::load_scene(path, &handle->notes, cap, progress));
  return handle;
}

pliant_scene* given_out(std::unique_ptr<SceneHandle> handle) {
  void* const made = make_handle(HandleKind::kScene, std::move(handle));
  if (!made) throw std::bad_alloc();
  return static_cast<pliant_scene*>(made);
}

template <class T, class From>
void copy(std::vector<T>& to, const From* from, std::size_t vertices) {
  if (!from) return;
  static_assert(sizeof(T) % sizeof(From) == 0);
  const auto* const first = reinterpret_cast<const T*>(from);
  to.assign(first, first + vertices);
}

pliant::MeshData mesh_of_c(const pliant_mesh* mesh) {
  const pliant_mesh& m = sized(mesh, "mesh");
  needed(m.position, "mesh->position");
  needed(m.index, "mesh->index");
  if (m.vertex_count < 3 || m.index_count < 3 || m.index_count % 3 != 0)
    throw Misuse{"`mesh` has " + std::to_string(m.vertex_count) + " vertices and " + std::to_string(m.index_count) +
                     " indices; it must have a triangle, and three indices per triangle",
                 "", "call.mesh"};
  pliant::MeshData data;
  copy(data.position, m.position, m.vertex_count);
  data.index.assign(m.index, m.index + m.index_count);
  for (const std::uint32_t index : data.index)
    if (index >= m.vertex_count)
      throw Misuse{"`mesh->index` has " + std::to_string(index) + ", and there are " + std::to_string(m.vertex_count) +
                       " vertices",
                   "", "call.mesh"};
  copy(data.normal, m.normal, m.vertex_count);
  copy(data.uv, m.uv, m.vertex_count);
  copy(data.stiffness, m.stiffness, m.vertex_count);
  copy(data.friction, m.friction, m.vertex_count);
  copy(data.damping, m.damping, m.vertex_count);
  copy(data.relaxation, m.relaxation, m.vertex_count);
  copy(data.pinned, m.pinned, m.vertex_count);
  copy(data.handle, m.handle, m.vertex_count);
  return data;
}

pliant::Placement placement_of_c(const pliant_placement* at) {
  if (!at) return {};
  const pliant_placement& c = sized(at, "at");
  pliant::Placement placement{of_c(c.pose.position), of_c(c.pose.rotation)};
  if (c.scale.x != 0.0 || c.scale.y != 0.0 || c.scale.z != 0.0) placement.scale = of_c(c.scale);
  return placement;
}

template <class F>
pliant_status with_scene(pliant_scene* scene, const char* call, F&& act) noexcept {
  return border(call, [&] {
    const Held held(scene, HandleKind::kScene);
    throw_unless_held(held, "scene");
    act(static_cast<SceneHandle&>(*held.slot().object));
  });
}

}  // namespace

pliant_status pliant_scene_load(const char* path, const pliant_load_options* options, pliant_scene** out) {
  return border(__func__, [&] {
    needed(out, "out");
    *out = given_out(loaded(text(path, "path"), options));
  });
}

pliant_status pliant_scene_load_memory(const void* bytes, size_t byte_count, const char* name,
                                       const pliant_load_options* options, pliant_scene** out) {
  return border(__func__, [&] {
    needed(out, "out");
    if (!bytes) throw_null("bytes");
    const fs::path file = fs::path(text(name, "name")).filename();
    if (!file.has_extension())
      throw Misuse{"`name` has no extension, which says the format", "pass a name such as organ.glb", "call.name"};
    const TemporaryFolder folder;
    const fs::path path = folder.path / file;
    std::ofstream stream(path, std::ios::binary);
    stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(byte_count));
    stream.close();
    if (!stream)
      throw pliant::Error{path.string(), "cannot be written", "set TMPDIR to a folder with room", "disk.full"};
    const std::string prefix = folder.path.string() + '/';
    try {
      auto handle = loaded(path, options);
      for (std::string& note : handle->notes) note = without(note, prefix);
      handle->folder = prefix;
      *out = given_out(std::move(handle));
    } catch (const pliant::Error& error) {
      throw without(error, prefix);
    }
  });
}

pliant_status pliant_scene_create(const char* name, pliant_scene** out) {
  return border(__func__, [&] {
    needed(out, "out");
    auto handle = std::make_unique<SceneHandle>();
    handle->scene = pliant::Scene(text(name, "name"));
    *out = given_out(std::move(handle));
  });
}

pliant_status pliant_scene_destroy(pliant_scene* scene) {
  if (!scene) return PLIANT_OK;
  return border(__func__, [&] {
    Held held(scene, HandleKind::kScene);
    throw_unless_held(held, "scene");
    held.destroy();
  });
}

pliant_status pliant_scene_save(pliant_scene* scene, const char* path) {
  return with_scene(scene, __func__, [&](SceneHandle& of) { check(pliant::save_scene(of.scene, text(path, "path"))); });
}

pliant_status pliant_scene_note_count(pliant_scene* scene, size_t* count) {
  return with_scene(scene, __func__, [&](SceneHandle& of) { needed(count, "count") = of.notes.size(); });
}

pliant_status pliant_scene_note(pliant_scene* scene, size_t index, const char** out) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    needed(out, "out");
    throw_unless_below(index, of.notes.size(), "");
    *out = of.notes[index].c_str();
  });
}

pliant_status pliant_scene_add_surface(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                       const pliant_placement* at) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    of.scene.add_surface(text(name, "name"), mesh_of_c(mesh), {}, placement_of_c(at));
  });
}

pliant_status pliant_scene_add_soft_body(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                         const pliant_placement* at) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    of.scene.add_soft_body(text(name, "name"), mesh_of_c(mesh), {}, placement_of_c(at));
  });
}

pliant_status pliant_scene_add_rigid_body(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                          const pliant_placement* at) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    of.scene.add_rigid_body(text(name, "name"), mesh_of_c(mesh), {}, placement_of_c(at));
  });
}

pliant_status pliant_scene_add_handle(pliant_scene* scene, const char* body) {
  return with_scene(scene, __func__, [&](SceneHandle& of) { check(of.scene.add_handle(text(body, "body"))); });
}

pliant_status pliant_scene_add_probe(pliant_scene* scene, const char* name, const pliant_placement* at) {
  return with_scene(scene, __func__,
                    [&](SceneHandle& of) { of.scene.add_probe(text(name, "name"), {}, {}, placement_of_c(at)); });
}

pliant_status pliant_scene_add_effect(pliant_scene* scene, const char* name, const pliant_placement* at,
                                      const pliant_path_row* rows, size_t count) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    of.scene.add_effect(text(name, "name"), {}, placement_of_c(at), path_of_c(rows, count, false));
  });
}

pliant_status pliant_scene_add_joint(pliant_scene* scene, const char* name, const char* a, const char* b,
                                     const pliant_placement* at) {
  return with_scene(scene, __func__, [&](SceneHandle& of) {
    pliant::JointParameters joint;
    joint.a = text(a, "a");
    if (b) joint.b = b;
    of.scene.add_joint(text(name, "name"), joint, placement_of_c(at));
  });
}

pliant_status pliant_scene_set(pliant_scene* scene, const char* assignment) {
  return with_scene(scene, __func__,
                    [&](SceneHandle& of) { check(pliant::set_key(of.scene, text(assignment, "assignment"))); });
}
