// Operations on a whole mesh, on threads: fills, gradients, refinement, unsharing a mesh.
#include <fmt/format.h>

#include <numeric>

#include "editor/core/editor.h"
#include "editor/core/painting.h"

namespace pliant {
namespace {

constexpr const char* kJob = "paint";

std::vector<std::uint32_t> all_vertices(const PaintSurface& surface) {
  std::vector<std::uint32_t> all(surface.mesh().vertex_count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

std::string lower(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

bool Painting::busy() const {
  return editor_.jobs.running(kJob);
}

// `make` runs on a thread; its changes are applied unless the paint has changed meanwhile.
void Painting::change(
    const std::string& what,
    std::function<PaintChanges(const MeshPaint&, const PaintSurface&, const std::atomic<bool>&)> make) {
  const auto number = mesh();
  const auto on = surface();
  if (!number || !on || busy() || stroke_) return;
  const auto of = editor_.state().meshes[*number];
  const auto before = std::make_shared<const std::vector<PaintLayer>>(layers(*number));
  editor_.jobs.start(kJob, what,
                     [this, what, make, on, of, before, number = *number,
                      channel = channel](const Jobs::Stop& stop) -> std::function<void(Editor&)> {
                       const MeshPaint paint = paint_of(*before, *on, attribute_of(channel));
                       const PaintChanges changes = make(paint, *on, stop);
                       const MeshPaint after = with(paint, changes);
                       std::vector<std::pair<std::uint32_t, PaintLayer>> changed;
                       for (const PaintedRange& range : changes.ranges)
                         changed.emplace_back(range.primitive, after.layers[range.primitive]);
                       return [this, what, changed, of, before, number, channel](Editor& editor) {
                         const State& state = editor.state();
                         bool same = number < state.meshes.size() && state.meshes[number] == of;
                         for (std::uint32_t p = 0; same && p < before->size(); ++p) {
                           const auto it = state.paint.find({number, p, channel});
                           same = it == state.paint.end() ? (*before)[p].size() == 0 : it->second == (*before)[p];
                         }
                         if (!same) {
                           editor.say(what + ": the paint has changed meanwhile; nothing was done, so do it again.",
                                      Severity::kWarning);
                           return;
                         }
                         if (changed.empty())
                           editor.say(what + ": it is so already.");
                         else
                           put(what, changed, number, channel, {});
                       };
                     });
}

void Painting::fill_all() {
  change("Fill " + lower(text_of(channel).title),
         [value = value_now()](const MeshPaint& paint, const PaintSurface& on, const std::atomic<bool>&) {
           return fill(paint, on, all_vertices(on), value);
         });
}

void Painting::fill_part(const SurfaceHit& at) {
  change("Fill a part's " + lower(text_of(channel).title),
         [value = value_now(), at, mask = brush.mask](const MeshPaint& paint, const PaintSurface& on,
                                                      const std::atomic<bool>&) {
           return fill(paint, on, on.connected(at, mask), value);
         });
}

void Painting::gradient(const SurfaceHit& from, const SurfaceHit& to) {
  const bool masked = brush.mask.part || brush.mask.creases || brush.mask.primitive;
  change("Gradient of " + lower(text_of(channel).title),
         [=, a = gradient_from, b = gradient_to, mask = brush.mask](const MeshPaint& paint, const PaintSurface& on,
                                                                    const std::atomic<bool>&) {
           return pliant::gradient(paint, on, masked ? on.connected(from, mask) : all_vertices(on), from.point,
                                   to.point, a, b);
         });
}

void Painting::clear() {
  if (const auto number = mesh(); number && !stroke_)
    editor_.apply("Clear " + lower(text_of(channel).title), without_layer(editor_.state(), *number, channel));
}

// The mesh with all its paint.
LevelMesh Painting::whole_mesh(std::uint32_t mesh) const {
  const State& state = editor_.state();
  LevelMesh whole = *state.meshes[mesh];
  for (const auto& [key, layer] : state.paint)
    if (key.mesh == mesh) painted(whole.primitives[key.primitive], key.channel) = layer.flatten();
  return whole;
}

void Painting::make_single() {
  const auto number = mesh();
  if (number && !stroke_)
    editor_.apply("Make the mesh single", with_mesh(editor_.state(), node(), whole_mesh(*number)));
}

void Painting::refine(const SurfaceHit& at) {
  const auto number = mesh();
  const auto on = surface();
  if (!number || !on || !at.valid() || busy() || stroke_) return;
  // The state shares its data, so the thread can build the whole mesh from it.
  const auto of = editor_.state().meshes[*number];
  std::vector<std::pair<LayerKey, PaintLayer>> paint;
  for (const auto& [key, layer] : editor_.state().paint)
    if (key.mesh == *number) paint.emplace_back(key, layer);
  editor_.jobs.start(
      kJob, "Refining",
      [this, of, paint, on, at, brush = brush, id = node(),
       number = *number](const Jobs::Stop&) -> std::function<void(Editor&)> {
        LevelMesh whole = *of;
        for (const auto& [key, layer] : paint) painted(whole.primitives[key.primitive], key.channel) = layer.flatten();
        MarchWork work;
        const std::optional<CoarseMesh> coarse = coarse_for(brush, *on, at, work);
        if (!coarse)
          return
              [](Editor& editor) { editor.say("The mesh is fine enough here for this brush; nothing was refined."); };
        auto refined =
            std::make_shared<Result<RefinedMesh>>(refine_under(whole, *on, at, brush.radius, coarse->wanted));
        return [this, refined, of, paint, id, number](Editor& editor) {
          if (!*refined) return editor.say(refined->error().message(), Severity::kError);
          const State& state = editor.state();
          const DocumentNode* const node = state.find(id);
          std::size_t layers = 0;
          bool same = node && node->node.mesh == static_cast<std::int32_t>(number) && state.meshes[number] == of;
          for (const auto& [key, layer] : state.paint)
            if (key.mesh == number) ++layers;
          same = same && layers == paint.size();
          for (const auto& [key, layer] : paint) {
            const auto it = state.paint.find(key);
            same = same && it != state.paint.end() && it->second == layer;
          }
          if (!same)
            return editor.say("Refine: the mesh has changed meanwhile; nothing was done, so do it again.",
                              Severity::kWarning);
          if ((*refined)->triangles_after == (*refined)->triangles_before) return editor.say((*refined)->sentence);
          const std::string sentence = (*refined)->sentence;
          const std::size_t others = sharing().size();
          if (editor.apply("Refine the mesh", with_mesh(state, id, std::move((*refined)->mesh)))) {
            editor.say("Refined: " + sentence + (others > 1 ? "; the node has a mesh of its own now" : "") + ".");
            pressed.reset();
            hover.reset();
          }
        };
      });
}

void Painting::look_whether_coarse(const SurfaceHit& hit, bool was_pressed) {
  const auto on = surface();
  if (!on || !hit.valid()) return;
  const std::string key = was_pressed ? "coarse where pressed" : "coarse under the mouse";
  editor_.jobs.start(key, "", [this, on, hit, was_pressed, brush = brush, id = node()](const Jobs::Stop&) {
    MarchWork work;
    const Place found{id, on, hit, coarse_for(brush, *on, hit, work), brush.radius};
    return [this, found, was_pressed](Editor&) { (was_pressed ? pressed : hover) = found; };
  });
}

}  // namespace pliant
