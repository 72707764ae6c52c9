// merge_document: meshes. Changed paint is written into the document's primitives. Meshes of changed shape are
// rewritten. A skin is kept if it still gives the shape in the Level.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_append.h"
#include "content/gltf/write/gltf_merge.h"
#include "content/gltf/write/gltf_save.h"

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

// Whether a node's joints have kept their place relative to it, within rounding, so that its skin gives the same shape.
class SkinsAtRest {
 public:
  explicit SkinsAtRest(const Merge& merge) : merge_(merge) {
    if (!merge.document.json.contains("skins")) return;
    const std::vector<LevelNode>& read = merge.level.source->nodes_as_read;
    then_.resize(read.size());
    now_.resize(read.size());
    const std::vector<dmat4> before = world_matrices(read), after = world_matrices(merge.level.nodes);
    for (std::size_t i = 0; i < read.size(); ++i) then_[static_cast<std::size_t>(read[i].source)] = before[i];
    for (std::size_t i = 0; i < merge.from.size(); ++i)
      if (merge.from[i] >= 0) now_[static_cast<std::size_t>(merge.from[i])] = after[i];
  }
  bool is(std::int32_t node) const {
    const Json& json = merge_.level.source->json;
    const std::size_t at = static_cast<std::size_t>(node);
    const Json& skin = json["skins"][json["nodes"][at]["skin"].get<std::size_t>()];
    for (const Json& number : skin["joints"]) {
      const std::size_t joint = number.get<std::size_t>();
      if (merge_.node_now[joint] < 0) return false;
      if (now_[joint] == then_[joint] && now_[at] == then_[at]) continue;
      const dmat4 then = glm::inverse(then_[at]) * then_[joint], now = glm::inverse(now_[at]) * now_[joint];
      double largest = 0.0, change = 0.0;
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) {
          largest = std::max(largest, std::abs(then[c][r]));
          change = std::max(change, std::abs(then[c][r] - now[c][r]));
        }
      if (!(change <= 1e-5 * largest)) return false;
    }
    return true;
  }

 private:
  const Merge& merge_;
  std::vector<dmat4> then_, now_;  // node to world, by number as read
};

class MeshMerge {
 public:
  explicit MeshMerge(Merge& merge) : merge_(merge), json_(merge.document.json), skins_(merge) {}

  Status all() {
    find_uses();
    if (const Status status = variants(); !status) return status;
    if (const Status status = append(); !status) return status;
    skins();
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

  // Appends meshes, materials, images and animations that are not in the document, with build_document.
  Status append();
  // The texture of the Level's image `i`.
  std::size_t texture_of(std::size_t image);
  void point_textures(Json& material);

  // Removes skins that have lost a joint.
  void skins() {
    if (!json_.contains("skins")) return;
    std::vector<bool> stays;
    for (Json& skin : json_["skins"]) {
      bool whole = true;
      for (Json& joint : skin["joints"]) {
        joint = merge_.node_now[joint.get<std::size_t>()];
        whole = whole && joint >= 0;
      }
      if (skin.contains("skeleton")) {
        const std::int32_t root = merge_.node_now[skin["skeleton"].get<std::size_t>()];
        if (root >= 0)
          skin["skeleton"] = root;
        else
          skin.erase("skeleton");
      }
      stays.push_back(whole);
    }
    skin_now_ = numbers_of_kept(stays);
    keep_elements(json_, "skins", skin_now_);
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

// Adds an offset to object[key] if present.
void shift(Json& object, const char* key, std::size_t by) {
  if (object.contains(key)) object[key] = object[key].get<std::size_t>() + by;
}

Status MeshMerge::append() {
  LevelParts parts;
  parts.first_material = array_of(json_, "materials").size();
  parts.first_image = array_of(json_, "images").size();
  for (std::size_t m = 0; m < anew_.size(); ++m)
    if (anew_[m]) parts.meshes.push_back(m);
  for (std::size_t a = 0; a < merge_.level.animations.size(); ++a)
    if (!is_as_read(merge_, a)) parts.animations.push_back(a);
  made_.assign(anew_.size(), -1);
  const bool any = !parts.meshes.empty() || !parts.animations.empty() ||
                   parts.first_material < merge_.level.materials.size() ||
                   parts.first_image < merge_.level.images.size();
  if (!any) return Done{};
  Result<BuiltParts> built = build_parts(merge_.level, parts);
  if (!built) return built.error();
  Json& add = built->document.json;
  const std::size_t accessors = array_of(json_, "accessors").size(), views = array_of(json_, "bufferViews").size(),
                    buffers = array_of(json_, "buffers").size(), meshes = array_of(json_, "meshes").size();
  const auto append_all = [&](const char* key, const auto& change) {
    if (!add.contains(key)) return;
    for (Json& each : add[key]) {
      change(each);
      json_[key].push_back(std::move(each));
    }
  };
  append_all("buffers", [](Json&) {});
  for (Bytes& bytes : built->document.buffers) merge_.document.buffers.push_back(std::move(bytes));
  append_all("bufferViews", [&](Json& view) { shift(view, "buffer", buffers); });
  append_all("accessors", [&](Json& accessor) { shift(accessor, "bufferView", views); });
  append_all("images", [&](Json& image) { shift(image, "bufferView", views); });
  merge_.document.images.resize(array_of(json_, "images").size());
  append_all("materials", [&](Json& material) { point_textures(material); });
  append_all("meshes", [&](Json& mesh) {
    for (Json& primitive : mesh["primitives"]) {
      shift(primitive, "indices", accessors);
      for (Json& number : primitive["attributes"]) number = number.get<std::size_t>() + accessors;
    }
  });
  append_all("animations", [&](Json& animation) {
    for (Json& sampler : animation["samplers"])
      for (const char* key : {"input", "output"}) shift(sampler, key, accessors);
    for (Json& channel : animation["channels"]) {
      Json& node = channel["target"]["node"];
      node = merge_.number[node.get<std::size_t>()];
    }
  });
  for (const Json& name : array_of(add, "extensionsUsed")) declare_extension(json_, name.get<std::string>(), false);
  for (std::size_t k = 0; k < parts.meshes.size(); ++k)
    if (const std::int32_t number = built->mesh_number[k]; number >= 0)
      made_[parts.meshes[k]] = static_cast<std::int32_t>(meshes) + number;
  return Done{};
}

std::size_t MeshMerge::texture_of(std::size_t image) {
  const Json& textures = array_of(json_, "textures");
  for (std::size_t t = 0; t < textures.size(); ++t)
    if (textures[t].contains("source") && textures[t]["source"] == image) return t;
  json_["textures"].push_back({{"source", image}});
  return json_["textures"].size() - 1;
}

// build_document numbers textures by their images.
void MeshMerge::point_textures(Json& json) {
  if (!json.is_object()) return;
  for (auto& [key, value] : json.items()) {
    const bool slot = key == "height_texture" || (key.size() > 7 && key.compare(key.size() - 7, 7, "Texture") == 0);
    if (slot && value.is_object() && value.contains("index"))
      value["index"] = texture_of(value["index"].get<std::size_t>());
    else
      point_textures(value);
  }
}

}  // namespace

Status merge_meshes(Merge& merge) {
  return MeshMerge(merge).all();
}

}  // namespace pliant
