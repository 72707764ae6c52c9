// Materials and pictures. Materials are only appended to, so that a number identifies the same one in every state.
#include "editor/document/edit_parts.h"

namespace pliant {
namespace {

std::int32_t add_material(State& next, Material material) {
  auto all = std::make_shared<std::vector<Material>>(next.materials());
  all->push_back(std::move(material));
  next.looks = std::move(all);
  return static_cast<std::int32_t>(next.materials().size()) - 1;
}

// Gives material `to` to the parts of the node's mesh that have `from`. Copies the mesh, with its paint.
void paint_over(State& next, DocumentNode& node, std::int32_t from, std::int32_t to) {
  const auto before = static_cast<std::uint32_t>(node.node.mesh);
  LevelMesh mesh = *next.meshes[before];
  for (Primitive& primitive : mesh.primitives)
    if (primitive.material == from) primitive.material = to;
  mesh.source = -1;
  const auto number = static_cast<std::uint32_t>(next.meshes.size());
  std::vector<std::pair<LayerKey, PaintLayer>> layers;
  for (const auto& [key, layer] : next.paint)
    if (key.mesh == before) layers.push_back({{number, key.primitive, key.channel}, layer});
  for (auto& [key, layer] : layers) next.paint.emplace(key, std::move(layer));
  next.meshes.push_back(std::make_shared<const DocumentMesh>(std::move(mesh)));
  node.node.mesh = static_cast<std::int32_t>(number);
}

const Primitive* part_of(const State& state, NodeId id, std::size_t primitive) {
  const DocumentNode* const node = state.find(id);
  if (!node || node->node.mesh < 0) return nullptr;
  const std::vector<Primitive>& parts = state.meshes[static_cast<std::size_t>(node->node.mesh)]->primitives;
  return primitive < parts.size() ? &parts[primitive] : nullptr;
}

bool exists(const State& state, std::int32_t material) {
  return material >= 0 && static_cast<std::size_t>(material) < state.materials().size();
}

}  // namespace

void LooksBrought::bring(State& to, const State& from, LevelMesh& mesh) {
  for (Primitive& primitive : mesh.primitives) {
    if (!exists(from, primitive.material)) {
      primitive.material = -1;
      continue;
    }
    auto [known, fresh] = material_.try_emplace(primitive.material, -1);
    if (fresh) {
      Material copy = from.materials()[static_cast<std::size_t>(primitive.material)];
      for (const auto texture : kTextures) {
        if (copy.*texture < 0) continue;
        auto [image, unknown] = image_.try_emplace(copy.*texture, -1);
        if (unknown) to = with_image(to, from.rest->images[static_cast<std::size_t>(copy.*texture)], image->second);
        copy.*texture = image->second;
      }
      known->second = add_material(to, std::move(copy));
    }
    primitive.material = known->second;
  }
}

Result<State> with_material(const State& state, NodeId id, std::size_t primitive, const Material& material) {
  const Primitive* const part = part_of(state, id, primitive);
  if (!part) return Error{"material", "the object has no such part"};
  std::optional<NodeChange> change = changing(state, id);
  State& next = change->state;
  if (exists(state, part->material)) {
    auto all = std::make_shared<std::vector<Material>>(state.materials());
    (*all)[static_cast<std::size_t>(part->material)] = material;
    next.looks = std::move(all);
    return next;
  }
  paint_over(next, *change->node, part->material, add_material(next, material));
  return next;
}

Result<State> with_own_material(const State& state, NodeId id, std::size_t primitive) {
  const Primitive* const part = part_of(state, id, primitive);
  if (!part || !exists(state, part->material)) return Error{"material", "the part has none"};
  std::optional<NodeChange> change = changing(state, id);
  State& next = change->state;
  const std::int32_t number = add_material(next, state.materials()[static_cast<std::size_t>(part->material)]);
  paint_over(next, *change->node, part->material, number);
  return next;
}

std::size_t sharing_material(const State& state, NodeId id, std::size_t primitive) {
  const Primitive* const part = part_of(state, id, primitive);
  if (!part || part->material < 0) return 0;
  std::size_t others = 0;
  for (const auto& each : state.nodes) {
    if (each->id == id || each->node.mesh < 0) continue;
    for (const Primitive& other : state.meshes[static_cast<std::size_t>(each->node.mesh)]->primitives)
      if (other.material == part->material) {
        ++others;
        break;
      }
  }
  return others;
}

State with_image(const State& state, Image image, std::int32_t& number) {
  State next = state;
  auto rest = std::make_shared<Level>(*state.rest);
  number = static_cast<std::int32_t>(rest->images.size());
  rest->images.push_back(std::move(image));
  next.rest = std::move(rest);
  return next;
}

Result<State> with_object(const State& state, NodeId id, LevelNode node, LevelMesh mesh, Material material) {
  State next = state;
  const std::int32_t number = add_material(next, std::move(material));
  for (Primitive& primitive : mesh.primitives) primitive.material = number;
  node.mesh = static_cast<std::int32_t>(next.meshes.size());
  next.meshes.push_back(std::make_shared<const DocumentMesh>(std::move(mesh)));
  return with_node(next, id, kNoNode, std::move(node));
}

}  // namespace pliant
