#include "editor/core/painting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/core/editor.h"

namespace pliant {
namespace {

constexpr double kLeastRadius = 1e-3, kMostRadius = 1.0;  // [1] of the diagonal of the painted object

constexpr ChannelText kTexts[] = {
    {"Stiffness", "How hard the surface is to press in: a factor on the stiffness, in its force and its own motion.",
     "deformable", "stiffness", "N/m"},
    {"Friction", "How much a probe sticks and rubs: a factor on both coefficients of friction.", "deformable",
     "friction_sliding", ""},
    {"Damping", "How fast the surface comes to rest: a factor on the damping of its motion and of the contact.",
     "deformable", "damping_ratio", ""},
    {"Relaxation", "How much force fades while a press is held: a factor on the relaxing arm of the law sls.",
     "deformable", "relaxation.stiffness", "N/m"},
    {"Pinned", "Where a soft body is held fast: from 0.5 up, unless its key `pinned` is a box.", "soft_body", "", ""},
    {"Handle", "Which part of a soft body is rigid and held by a device: from 0.5 up, unless the handle has a box.",
     "handle", "", ""}};

// Two digits, so that the displayed number is exact.
double rounded(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / step) * step;
}

// [m] distance beyond the clip plane; 0 or less: visible.
double cut_away(const Editor& editor, const dvec3& place) {
  const ClipPlane& plane = editor.view.clip;
  const Box box = editor.scene_box();
  if (!plane.on || box.empty()) return 0.0;
  const double at =
      std::lerp(static_cast<double>(box.min[plane.axis]), static_cast<double>(box.max[plane.axis]), plane.place);
  return plane.flipped ? at - place[plane.axis] : place[plane.axis] - at;
}

}  // namespace

const ChannelText& text_of(Channel channel) {
  return kTexts[static_cast<std::size_t>(channel)];
}

// --- Brush and channel

Brush Painting::brush_now() const {
  Brush now = brush;
  now.value = brush.mode == BrushMode::kAdd ? amounts[static_cast<std::size_t>(channel)] : value_now();
  return now;
}

void Painting::take_channel(Channel to) {
  if (to == channel) return;
  if (is_share(to) != is_share(channel)) {
    gradient_from = unpainted(to);
    gradient_to = is_share(to) ? 1.0 : 3.0;
  }
  channel = to;
}

void Painting::scale_radius(double by) {
  const double size = this->size();
  brush.radius = rounded(std::clamp(brush.radius * by, kLeastRadius * size, kMostRadius * size));
}

void Painting::fit_radius() {
  const double size = this->size();
  if (brush.radius < kLeastRadius * size || brush.radius > kMostRadius * size) brush.radius = rounded(0.06 * size);
}

void Painting::add_strength(double by) {
  brush.strength = std::clamp(std::round(100.0 * (brush.strength + by)) / 100.0, 0.01, 1.0);
}

// --- Painted object

NodeId Painting::node() const {
  const DocumentNode* const active = editor_.active_node();
  return active && active->node.mesh >= 0 ? active->id : kNoNode;
}

std::optional<std::uint32_t> Painting::mesh() const {
  const DocumentNode* const active = editor_.active_node();
  if (!active || active->node.mesh < 0) return {};
  return static_cast<std::uint32_t>(active->node.mesh);
}

std::shared_ptr<const PaintSurface> Painting::surface() {
  const NodeId id = node();
  return id == kNoNode ? nullptr : editor_.surface_of(id);
}

bool Painting::preparing() const {
  const std::vector<NodeId> all = sharing();
  return std::any_of(all.begin(), all.end(),
                     [&](NodeId id) { return editor_.jobs.running("surface " + std::to_string(id)); });
}

double Painting::size() const {
  const auto number = mesh();
  if (!number || editor_.state().meshes[*number]->box.empty()) return 1.0;
  const vec3 box = editor_.state().meshes[*number]->box.size();
  const double size = length(dmat3(editor_.state().to_world(node())) * dvec3(box));
  return size > 0.0 ? size : 1.0;
}

dvec3 Painting::corner() const {
  return dvec3(editor_.state().to_world(node())[3]);
}

SurfaceHit Painting::under(const PaintSurface& surface, const ViewRay& ray) const {
  SurfaceHit hit = surface.hit(seen(ray), brush.both_sides || editor_.view.clip.on);
  if (hit.valid() && editor_.view.clip.on && cut_away(editor_, hit.point + corner()) > 0.0) hit = {};
  return hit;
}

Ray Painting::seen(const ViewRay& ray) const {
  Ray seen{ray.from, ray.along};
  if (const double at = cut_away(editor_, ray.from); at > 0.0) {
    const double away = cut_away(editor_, ray.from + ray.along) - at;
    if (away < 0.0) seen.origin += at / -away * ray.along;
  }
  seen.origin -= corner();
  return seen;
}

SurfaceHit Painting::mirrored(const PaintSurface& surface, const SurfaceHit& hit) const {
  if (brush.mirror == BrushMirror::kNone || !hit.valid()) return {};
  dvec3 in_mesh = inverse(surface.frame()) * hit.point;
  double& across = in_mesh[static_cast<int>(brush.mirror) - static_cast<int>(BrushMirror::kX)];
  across = -across;
  return surface.closest(surface.frame() * in_mesh, brush.radius);
}

std::vector<PaintLayer> Painting::layers(std::uint32_t mesh) const {
  const State& state = editor_.state();
  std::vector<PaintLayer> all;
  for (std::uint32_t p = 0; p < state.meshes[mesh]->primitives.size(); ++p) {
    const auto it = state.paint.find({mesh, p, channel});
    all.push_back(it == state.paint.end() ? PaintLayer() : it->second);
  }
  return all;
}

double Painting::value_at(const PaintSurface& surface, const SurfaceHit& hit) const {
  const auto number = mesh();
  if (!number || !hit.valid()) return unpainted(channel);
  // At a seam between painted and unpainted primitives, the painted ones count.
  const std::vector<PaintLayer> all = layers(*number);
  double value = 0.0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0;
    int count = 0;
    for (const SourceVertex& s : surface.sources(surface.mesh().triangles[hit.triangle][i]))
      if (all[s.primitive].size() > 0) sum += static_cast<double>(all[s.primitive].value(s.index)), ++count;
    value += hit.barycentric[i] * (count > 0 ? sum / count : static_cast<double>(unpainted(channel)));
  }
  return value;
}

std::string Painting::value_text(double value) const {
  const ChannelText& text = text_of(channel);
  if (is_share(channel)) return fmt::format("{:.3g}: {}", value, value >= 0.5 ? "held" : "free");
  const Json of = value_of_key(editor_.state(), node(), text.extension, text.key);
  if (!of.is_number()) return fmt::format("{:.3g} \u00d7", value);
  const double base = of.get<double>();
  const std::string unit = *text.unit ? std::string(" ") + text.unit : "";
  return fmt::format("{:.3g} \u00d7 {:.4g}{} = {:.4g}{}", value, base, unit, value * base, unit);
}

std::vector<NodeId> Painting::sharing() const {
  std::vector<NodeId> all;
  if (const auto number = mesh())
    for (const auto& each : editor_.state().nodes)
      if (each->node.mesh == static_cast<std::int32_t>(*number)) all.push_back(each->id);
  return all;
}

std::string Painting::lacks() const {
  const ChannelText& text = text_of(channel);
  if (has_component(editor_.state(), node(), text.extension)) return {};
  std::string name = text.extension;
  std::replace(name.begin(), name.end(), '_', ' ');
  return "The node has no " + name + ": the paint is kept, but not felt.";
}

std::optional<std::pair<double, double>> Painting::painted_range() const {
  const auto number = mesh();
  if (!number) return {};
  std::optional<std::pair<double, double>> range;
  for (const PaintLayer& layer : layers(*number))
    for (std::size_t c = 0; c < layer.chunk_count(); ++c)
      for (std::size_t i = 0; i < std::min(PaintLayer::kChunk, layer.size() - c * PaintLayer::kChunk); ++i) {
        const double value = static_cast<double>(layer.chunk(c)[i]);
        if (!range) range = {value, value};
        range->first = std::min(range->first, value);
        range->second = std::max(range->second, value);
      }
  return range;
}

// --- A stroke

void Painting::press(const ViewRay& ray, double pressure, BrushMode mode) {
  const auto number = mesh();
  const auto on = surface();
  if (!number || !on || stroke_) return;
  const ChannelText& text = text_of(channel);
  std::string name = text.title;
  name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  constexpr const char* kWords[] = {"Paint ", "Add to ", "Smooth ", "Erase "};
  stroking_ = {editor_.state().meshes[*number],
               *number,
               channel,
               layers(*number),
               kWords[static_cast<std::size_t>(mode)] + name,
               fmt::format("stroke {}", ++strokes_),
               editor_.document.step()};
  Brush now = brush;
  now.mode = mode;
  now.value = mode == BrushMode::kAdd ? amounts[static_cast<std::size_t>(channel)] : value_now();
  now.both_sides = brush.both_sides || editor_.view.clip.on;
  stroke_ = std::make_unique<LiveStroke>(on, stroking_.shown, attribute_of(channel), now, editor_.jobs.wake);
  move(ray, pressure);
}

void Painting::move(const ViewRay& ray, double pressure) {
  if (stroke_) stroke_->move(seen(ray), pressure);
}

void Painting::release() {
  if (stroke_) stroke_->finish();
}

void Painting::give_up() {
  if (!stroke_) return;
  stroke_.reset();
  if (stroking_.applied && editor_.document.step() == stroking_.step + 1) editor_.undo();
  editor_.document.end_gesture();
}

void Painting::update() {
  if (!stroke_) return;
  const State& state = editor_.state();
  const Under& s = stroking_;
  // The paint was changed from elsewhere: undo, another file.
  bool ours = s.mesh < state.meshes.size() && state.meshes[s.mesh] == s.of;
  for (std::uint32_t p = 0; ours && p < s.shown.size(); ++p) {
    const auto it = state.paint.find({s.mesh, p, s.channel});
    ours = it == state.paint.end() ? s.shown[p].size() == 0 : it->second == s.shown[p];
  }
  if (!ours) {
    stroke_.reset();
    return;
  }
  const bool last = stroke_->finished();
  const LiveStroke::Made made = stroke_->take();
  if (!made.layers.empty()) {
    for (const auto& [primitive, layer] : made.layers) stroking_.shown[primitive] = layer;
    stroking_.applied = true;
    put(s.what, made.layers, s.mesh, s.channel, s.gesture);
  }
  if (!last) return;
  stroke_.reset();
  editor_.document.end_gesture();
}

void Painting::put(const std::string& what, const std::vector<std::pair<std::uint32_t, PaintLayer>>& layers,
                   std::uint32_t mesh, Channel of, const std::string& gesture) {
  Result<State> next = editor_.state();
  for (const auto& [primitive, layer] : layers)
    if (next) next = with_layer(*next, {mesh, primitive, of}, layer);
  editor_.apply(what, std::move(next), gesture);
}

}  // namespace pliant
