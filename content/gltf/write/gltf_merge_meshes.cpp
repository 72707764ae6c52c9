// merge_document: meshes. Changed paint is written into the document's primitives. Meshes of changed shape are
// rewritten.
#include <algorithm>
#include <map>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_append.h"
#include "content/gltf/write/gltf_merge.h"
#include "content/gltf/write/gltf_merge_skins.h"

namespace pliant {

namespace {

using Paint = std::vector<std::array<std::uint64_t, kPainted.size()>>;  // of every primitive

Paint paint_of(const MeshAsRead& mesh) {
  Paint out;
  for (const PrimitiveAsRead& primitive : mesh.primitives) out.push_back(primitive.painted);
  return out;
}

bool same_shape(const MeshAsRead& a, const MeshAsRead& b) {
  const auto same = [](const PrimitiveAsRead& x, const PrimitiveAsRead& y) {
    return x.source == y.source && x.shape == y.shape;
  };
  return std::equal(a.primitives.begin(), a.primitives.end(), b.primitives.begin(), b.primitives.end(), same);
}

class MeshMerge {
 public:
  explicit MeshMerge(Merge& merge) : merge_(merge), json_(merge.document.json), skins_(merge) {}

  Status all() {
    find_uses();
    if (const Status status = variants(); !status) return status;
    if (const Status status = append_parts(merge_, anew_, made_); !status) return status;
    skin_now_ = merge_skins(merge_);
    nodes();
    return Done{};
  }

 private:
  const LevelMesh& mesh(std::size_t m) const { return merge_.level.meshes[m]; }

  // Decides how each mesh is written: as in the document, or anew.
  void find_uses() {
    const std::vector<LevelMesh>& meshes = merge_.level.meshes;
    std::map<std::pair<std::int32_t, std::int32_t>, const MeshAsRead*> read;
    for (const MeshAsRead& each : merge_.level.source->meshes_as_read) read[{each.source, each.skinned}] = &each;
    for (const LevelMesh& each : meshes) {
      now_.push_back(fingerprint(each));
      const auto found = read.find({each.source, each.skinned});
      read_.push_back(found != read.end() && same_shape(*found->second, now_.back()) ? found->second : nullptr);
    }
    as_read_.resize(meshes.size());
    anew_.resize(meshes.size());
    for (std::size_t n = 0; n < merge_.level.nodes.size(); ++n) {
      const std::int32_t m = merge_.level.nodes[n].mesh;
      if (m < 0) continue;
      const bool as_read = shows_as_read(n, static_cast<std::size_t>(m));
      (as_read ? as_read_ : anew_)[static_cast<std::size_t>(m)] = true;
    }
    for (std::size_t m = 0; m < meshes.size(); ++m) unused_.push_back(!as_read_[m] && !anew_[m]);
    for (std::size_t m = 0; m < meshes.size(); ++m)
      if (unused_[m] && mesh(m).skinned < 0) (read_[m] ? as_read_ : anew_)[m] = true;
  }
  // A skinned mesh equals the document's only on the node that has its skin.
  bool shows_as_read(std::size_t node, std::size_t m) const {
    if (!read_[m] || mesh(m).skinned < 0) return read_[m] != nullptr;
    return merge_.from[node] == mesh(m).skinned && skins_.is(mesh(m).skinned);
  }

  // One element of /meshes/i per painted variant: the first keeps its place, others are copies.
  Status variants() {
    number_.assign(now_.size(), -1);
    if (!json_.contains("meshes")) return Done{};
    const Json read = json_["meshes"];
    Json copies = Json::array();
    std::vector<std::map<Paint, std::int32_t>> made(read.size());
    const std::int32_t copy = 1 << 30;  // temporary numbers of copies, until the number of kept meshes is known
    for (const auto& chosen : {in_use(false), in_use(true), unused()})
      for (const std::size_t m : chosen) {
        const std::size_t source = static_cast<std::size_t>(mesh(m).source);
        const auto [at, is_new] = made[source].insert({paint_of(now_[m]), -1});
        if (is_new && made[source].size() > 1 && unused_[m]) continue;  // no node shows it
        if (is_new) {
          const bool first = made[source].size() == 1;
          if (!first) copies.push_back(read[source]);
          at->second = first ? mesh(m).source : copy + static_cast<std::int32_t>(copies.size()) - 1;
          if (const Status status = paint(first ? json_["meshes"][source] : copies.back(), m); !status) return status;
        }
        number_[m] = at->second;
      }
    std::vector<bool> stays;
    for (const auto& each : made) stays.push_back(!each.empty());
    merge_.mesh_now = numbers_of_kept(stays);
    merge_.dropped = merge_.dropped || std::find(stays.begin(), stays.end(), false) != stays.end();
    keep_elements(json_, "meshes", merge_.mesh_now);
    const std::int32_t kept = static_cast<std::int32_t>(array_of(json_, "meshes").size());
    for (std::int32_t& number : number_)
      if (number >= 0)
        number = number >= copy ? kept + number - copy : merge_.mesh_now[static_cast<std::size_t>(number)];
    for (Json& each : copies) json_["meshes"].push_back(std::move(each));
    return Done{};
  }
  std::vector<std::size_t> in_use(bool skinned) const {
    std::vector<std::size_t> out;
    for (std::size_t m = 0; m < now_.size(); ++m)
      if (as_read_[m] && !unused_[m] && (mesh(m).skinned >= 0) == skinned) out.push_back(m);
    return out;
  }
  std::vector<std::size_t> unused() const {
    std::vector<std::size_t> out;
    for (std::size_t m = 0; m < now_.size(); ++m)
      if (as_read_[m] && unused_[m]) out.push_back(m);
    return out;
  }

  // Writes painted attributes and the name. A Primitive's vertices have the order of the decoded Draco data. An
  // attribute beside Draco data is an accessor in that order.
  Status paint(Json& out, std::size_t m) {
    if (mesh(m).name != value_of<std::string>(out, "name", "")) out["name"] = mesh(m).name;
    for (std::size_t p = 0; p < now_[m].primitives.size(); ++p) {
      const Primitive& primitive = mesh(m).primitives[p];
      Json& to = out["primitives"][static_cast<std::size_t>(primitive.source)];
      for (std::size_t k = 0; k < kPainted.size(); ++k) {
        if (now_[m].primitives[p].painted[k] == read_[m]->primitives[p].painted[k]) continue;
        const std::vector<float>& values = primitive.*kPainted[k].values;
        if (!values.empty() && values.size() != primitive.position.size())
          return Error{mesh(m).name, "has attributes of different lengths and cannot be saved"};
        merge_.dropped = merge_.dropped || to["attributes"].contains(kPainted[k].name);
        to["attributes"].erase(kPainted[k].name);
        if (extension_of(to, "KHR_draco_mesh_compression"))
          to["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase(kPainted[k].name);
        if (!values.empty())
          to["attributes"][kPainted[k].name] = add_accessor(merge_.document, values, kFloat, 1, 34962);
      }
    }
    return Done{};
  }

  void nodes() {
    for (std::size_t n = 0; n < merge_.level.nodes.size(); ++n) {
      Json& object = merge_.object(n);
      const std::int32_t m = merge_.level.nodes[n].mesh;
      const bool as_read = m >= 0 && shows_as_read(n, static_cast<std::size_t>(m));
      const std::int32_t number = m < 0     ? -1
                                  : as_read ? number_[static_cast<std::size_t>(m)]
                                            : made_[static_cast<std::size_t>(m)];
      const std::int32_t skin =
          as_read && mesh(static_cast<std::size_t>(m)).skinned >= 0 ? skin_now_[object["skin"].get<std::size_t>()] : -1;
      set(object, "mesh", number);
      set(object, "skin", skin);
      const std::size_t targets =
          number < 0 ? 0
                     : array_of(json_["meshes"][static_cast<std::size_t>(number)]["primitives"][0], "targets").size();
      if (object.contains("weights") && object["weights"].size() != targets) object.erase("weights");
    }
  }
  static void set(Json& object, const char* key, std::int32_t number) {
    if (number < 0)
      object.erase(key);
    else
      object[key] = number;
  }

  Merge& merge_;
  Json& json_;
  SkinsAtRest skins_;
  // By Level mesh.
  std::vector<MeshAsRead> now_;
  std::vector<const MeshAsRead*> read_;        // nullptr: new, or its shape has changed since reading
  std::vector<bool> as_read_, anew_, unused_;  // some node shows it as in the document; some node as new; no node
  std::vector<std::int32_t> number_, made_;    // number in /meshes of the kept one; of the new one
  std::vector<std::int32_t> skin_now_;         // /skins/i as read -> now
};

}  // namespace

Status merge_meshes(Merge& merge) {
  return MeshMerge(merge).all();
}

}  // namespace pliant
