#include "content/level/soft_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "content/files/file_io.h"
#include "content/level/file_hash.h"
#include "runtime/assert.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

fs::path g_soft_store;

constexpr std::uint64_t kBegin = 0x36746f6f66546c50, kEnd = ~kBegin;  // of a file

// A structured binding names every member: a new one stops the build here.
void visit_members(auto& io, auto& of, const BuiltMesh*) {
  auto& [mesh, draw, report, pinned, handle] = of;
  io(mesh, draw, report, pinned, handle);
}
void visit_members(auto& io, auto& of, const Mesh*) {
  auto& [name, vertex_count, px, py, pz, nx, ny, nz, area, triangles, across, tree, zone_box, zone_neighbour_first,
         zone_neighbours, crease, split_normals, corner_normal, stiffness_factor, friction_factor, damping_factor,
         relaxation_factor, relief, of_source, box, mean_edge, file_edge, closed] = of;  // no relief: tissue has none
  io(name, vertex_count, px, py, pz, nx, ny, nz, area, triangles, across, tree, zone_box, zone_neighbour_first,
     zone_neighbours, crease, split_normals, corner_normal, stiffness_factor, friction_factor, damping_factor,
     relaxation_factor, of_source, box, mean_edge, file_edge, closed);
}
void visit_members(auto& io, auto& of, const TriangleTree*) {
  auto& [levels, nodes, bulge] = of;
  io(levels, nodes, bulge);
}
void visit_members(auto& io, auto& of, const DrawMesh*) {
  auto& [vertices, indices, parts] = of;
  io(vertices, indices, parts);
}
void visit_members(auto& io, auto& of, const TetMesh*) {
  auto& [name, nodes, free_count, handle_count, rigid_counts, tets, cells, volume, group, factors, embedding, samples,
         parts, cavities, start, quality, report] = of;
  // Carried nodes, contact keys, materials of parts and cavities belong to a World.
  ASSERT(parts.empty() && samples.empty() && factors.empty() && cavities.empty());
  io(name, nodes, free_count, handle_count, rigid_counts, tets, cells, volume, group, embedding, start, quality,
     report);
}
void visit_members(auto& io, auto& of, const TetReport*) {
  auto& [cell, coarsest, wall, parts_dropped, volume_dropped, thin, least_thickness, thinnest, notes, findings] = of;
  io(cell, coarsest, wall, parts_dropped, volume_dropped, thin, least_thickness, thinnest, notes, findings);
}
void visit_members(auto& io, auto& of, const Note*) {
  auto& [what, cure, code, about] = of;
  io(what, cure, code, about);
}
void visit_members(auto& io, auto& of, const SoftParts*) {
  auto& [surface, tets, notes, groups, split] = of;
  io(surface, tets, notes, groups, split);
}

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
constexpr bool kIsList = IsVector<T>::value || std::is_same_v<T, std::string>;

class SoftWriter {
 public:
  void operator()(const auto&... values) { (put(values), ...); }
  std::vector<std::uint8_t> bytes;

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      add(&value, sizeof value);
    } else if constexpr (kIsList<T>) {
      put(static_cast<std::uint64_t>(value.size()));
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>)
        add(value.data(), value.size() * sizeof(typename T::value_type));
      else
        for (const auto& each : value) put(each);
    } else {
      visit_members(*this, value, static_cast<const T*>(nullptr));
    }
  }
  void add(const void* from, std::size_t size) {
    const auto* const begin = static_cast<const std::uint8_t*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  }
};

class SoftReader {
 public:
  explicit SoftReader(const std::vector<std::uint8_t>& bytes) : at_(bytes.data()), left_(bytes.size()) {}
  void operator()(auto&... values) { (get(values), ...); }
  bool whole() const { return whole_; }  // so far

 private:
  template <class T>
  void get(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      take(&value, sizeof value);
    } else if constexpr (kIsList<T>) {
      std::uint64_t size = 0;
      get(size);
      if (size > left_) whole_ = false;  // an element has one byte at least
      if (!whole_) return;
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>) {
        if (size > left_ / sizeof(typename T::value_type)) whole_ = false;
        if (!whole_) return;
        value.resize(size);
        take(value.data(), size * sizeof(typename T::value_type));
      } else {
        value.resize(size);
        for (auto& each : value) get(each);
      }
    } else {
      visit_members(*this, value, static_cast<const T*>(nullptr));
    }
  }
  void take(void* to, std::size_t size) {
    if (size > left_) whole_ = false;
    if (!whole_ || size == 0) return;
    std::memcpy(to, at_, size);
    at_ += size, left_ -= size;
  }
  const std::uint8_t* at_;
  std::size_t left_;
  bool whole_ = true;
};

void add_box(Hash& hash, const Box& box) {
  for (int i = 0; i < 3; ++i) hash.add(box.min[i]), hash.add(box.max[i]);
}

}  // namespace

std::vector<std::uint8_t> bytes_of(const SoftParts& parts) {
  SoftWriter out;
  out(kBegin, parts, kEnd);
  return std::move(out.bytes);
}

std::optional<SoftParts> soft_parts_of(const std::vector<std::uint8_t>& bytes) {
  SoftReader in(bytes);
  std::optional<SoftParts> parts(std::in_place);
  std::uint64_t begin = 0, end = 0;
  in(begin);
  if (begin != kBegin) return std::nullopt;
  in(*parts, end);
  if (!in.whole() || end != kEnd) return std::nullopt;
  return parts;
}

LevelNode only_tissue(const LevelNode& node) {
  LevelNode out;
  out.name = node.name;
  SoftBody& body = out.soft_body.emplace();
  body.cell = node.soft_body->cell;
  body.focus = node.soft_body->focus;
  body.fill = node.soft_body->fill;
  body.thickness = node.soft_body->thickness;
  body.mesh = node.soft_body->mesh;
  body.elements = node.soft_body->elements;
  body.pinned = node.soft_body->pinned;
  body.rigid = node.soft_body->rigid;
  body.contact = node.soft_body->contact;
  if (node.deformable) {  // sizes of its dents
    out.deformable.emplace();
    out.deformable->shape = node.deformable->shape;
    out.deformable->reach = node.deformable->reach;
    out.deformable->contact_radius = node.deformable->contact_radius;
  }
  if (node.handle) out.handle.emplace().box = node.handle->box;
  return out;
}

std::uint64_t soft_key(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object, const fs::path& folder) {
  const LevelNode asked = only_tissue(node);
  const SoftBody& body = *asked.soft_body;
  Hash hash;
  add_text(hash, asked.name);
  hash.add(body.cell);
  add_box(hash, body.focus);
  hash.add(static_cast<int>(body.fill));
  hash.add(static_cast<int>(body.elements));
  hash.add(static_cast<int>(body.contact));
  hash.add(asked.deformable.has_value());
  if (const auto& law = asked.deformable)
    hash.add(static_cast<int>(law->shape)), hash.add(law->reach), hash.add(law->contact_radius);
  hash.add(body.thickness);
  add_text(hash, body.mesh);
  add_named_file(hash, folder, body.mesh);
  add_box(hash, body.pinned);
  for (const RigidPart& part : body.rigid) {
    add_text(hash, part.name);
    for (int i = 0; i < 3; ++i) hash.add(part.box.min[i]), hash.add(part.box.max[i]);
  }
  hash.add(asked.handle.has_value());
  if (asked.handle) add_box(hash, asked.handle->box);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) hash.add(to_object[column][row]);
  hash.add(most(limits::kTets));  // what is refused may not be found
  hash.add(mesh != nullptr);
  if (!mesh) return hash.value();
  hash.add(mesh->primitives.size());
  for (const Primitive& p : mesh->primitives) {
    add_values(hash, p.position);
    add_values(hash, p.normal);
    add_values(hash, p.tangent);
    add_values(hash, p.uv);
    add_values(hash, p.index);
    for (const std::vector<float>* painted :
         {&p.stiffness, &p.friction, &p.damping, &p.relaxation, &p.pinned, &p.handle})
      add_values(hash, *painted);
    hash.add(p.material);
  }
  return hash.value();
}

fs::path SoftStore::file_of(std::uint64_t key) const {
  return folder_ / fmt::format("{:016x}.body", key);
}

std::optional<SoftParts> SoftStore::find(std::uint64_t key) const {
  const fs::path file = file_of(key);
  const Result<Bytes> bytes = read_file(file);
  if (!bytes) return std::nullopt;
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return soft_parts_of(*bytes);
}

void SoftStore::keep(std::uint64_t key, const SoftParts& parts) const {
  const std::vector<std::uint8_t> bytes = bytes_of(parts);
  if (bytes.size() > most_) return;
  make_room(bytes.size());
  const Status ignored = write_file(file_of(key), bytes);  // appears whole or not at all
  static_cast<void>(ignored);
}

void SoftStore::make_room(std::uintmax_t bytes) const {
  struct Kept {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path file;
  };
  std::vector<Kept> kept;
  std::error_code error;
  std::uintmax_t all = bytes;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    std::error_code gone;
    const std::uintmax_t size = entry.file_size(gone);
    const fs::file_time_type used = entry.last_write_time(gone);
    if (gone) continue;
    kept.push_back({used, size, entry.path()});
    all += size;
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& each : kept) {
    if (all <= most_) return;
    fs::remove(each.file, error);
    all -= each.size;
  }
}

void set_soft_store(fs::path folder) {
  g_soft_store = std::move(folder);
}

Result<SoftParts> find_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const fs::path& folder) {
  if (g_soft_store.empty()) return make_soft_parts(only_tissue(node), mesh, to_object, folder);
  const SoftStore store(g_soft_store);
  const std::uint64_t key = soft_key(node, mesh, to_object, folder);
  if (std::optional<SoftParts> found = store.find(key)) return std::move(*found);
  Result<SoftParts> made = make_soft_parts(only_tissue(node), mesh, to_object, folder);
  if (made) store.keep(key, *made);
  return made;
}

}  // namespace pliant
