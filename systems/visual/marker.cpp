#include "systems/visual/marker.h"

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/visual/marker_shapes.h"

namespace pliant {
namespace {

// Sizes, as shares of the scene's diagonal unless stated otherwise.
constexpr float kSmallestBall = 0.012f;  // radius; smaller probes would be invisible
constexpr float kRodLength = 0.16f;
constexpr float kRodRadius = 0.42f;       // of the ball's radius
constexpr float kLean = 0.7f;             // [rad] of the rod from the outward direction
constexpr float kSteadyLean = 0.1f;       // [1] below, the rod leans less, to avoid fast rotation
constexpr float kCovered = 0.93f;         // [1] cosine: an arrow closer to the stylus is hidden by it
constexpr float kArrowPerNewton = 0.10f;  // [1/N]
constexpr float kLongestArrow = 0.30f;
constexpr float kArrowRadius = 0.0055f;
constexpr float kHeadRadius = 0.015f, kHeadLength = 0.04f;
constexpr float kSmallestForce = 0.01f;  // [N] below: no arrow
constexpr float kFrameLength = 0.09f, kFrameRadius = 0.004f;
constexpr float kNormalLength = 0.045f, kNormalRadius = 0.004f, kThinArrow = 0.4f;
constexpr float kWantedBall = 0.008f, kShortestCoupling = 1e-4f;
constexpr std::size_t kMostInstances = 9 + 2 * kMostShownContacts;  // per probe: ball, stylus, arrow (2), frame (3),
                                                                    // shaft and its end, arrows (2 each)
constexpr std::size_t kMostOfPart = 3;                              // two balls, shaft
constexpr std::size_t kMostOfContact = 3;                           // normal, arrow (2)
constexpr std::size_t kMostOfHandle = 7;                            // frame (3), coupling, the device's end, arrow (2)
const vec3 kFrameColors[3] = {{0.85f, 0.06f, 0.04f}, {0.08f, 0.75f, 0.06f}, {0.05f, 0.15f, 0.90f}};
const vec3 kArrowColor{0.95f, 0.70f, 0.03f};
const vec3 kRodColor{0.55f, 0.57f, 0.60f};
const vec3 kStickingColor{0.08f, 0.75f, 0.06f}, kSlidingColor{0.85f, 0.06f, 0.04f}, kCouplingColor{0.65f, 0.1f, 0.75f};

}  // namespace

Result<Markers> Markers::make(const World& world, std::vector<Box> boxes) {
  Markers made;
  Result<gpu::Program> program = gpu::Program::load({"marker.vert", "marker.frag"});
  if (!program) return program.error();
  made.program_ = *std::move(program);
  Result<gpu::Program> shadow = gpu::Program::load({"marker_shadow.vert", "marker_shadow.frag"});
  if (!shadow) return shadow.error();
  made.shadow_ = *std::move(shadow);
  Box scene;
  for (const Box& box : boxes)
    if (!box.empty()) scene.add(box);
  if (!scene.empty()) made.diagonal_ = std::max(scene.diagonal(), 1e-6f);
  made.boxes_ = std::move(boxes);
  for (auto [entity, probe] : world.registry.view<Probe>())
    made.probes_.push_back({entity,
                            static_cast<float>(probe.radius),
                            probe.color,
                            probe.placed,
                            probe.position,
                            probe.force,
                            dvec3(0),
                            probe.rotation,
                            probe_parts(probe),
                            0,
                            {}});

  MarkerMesh all;
  const MarkerMesh meshes[kKinds] = {make_ball(), make_rod(), make_cone()};
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    made.shapes_[kind] = {static_cast<std::uint32_t>(all.indices.size()),
                          static_cast<std::uint32_t>(meshes[kind].indices.size())};
    const std::uint32_t base = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), meshes[kind].vertices.begin(), meshes[kind].vertices.end());
    for (const std::uint32_t index : meshes[kind].indices) all.indices.push_back(base + index);
  }
  made.vertices_ = gpu::Buffer::fixed<MarkerVertex>(all.vertices);
  made.indices_ = gpu::Buffer::indices(all.indices);
  for ([[maybe_unused]] auto [entity, handle] : world.registry.view<Handle6>()) ++made.most_handles_;
  for ([[maybe_unused]] auto [entity, soft] : world.registry.view<SoftBody>()) made.most_contacts_ = kMaxShownContacts;
  for ([[maybe_unused]] auto [entity, rigid] : world.registry.view<RigidBody>())
    made.most_contacts_ = kMaxShownContacts;
  std::size_t parts = 0;
  for (const Known& probe : made.probes_) parts += probe.parts.size();
  const std::size_t most = made.probes_.size() * kMostInstances + kMostOfPart * parts +
                           made.most_contacts_ * kMostOfContact + made.most_handles_ * kMostOfHandle;
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    made.instances_[kind] = gpu::Buffer::writable(nullptr, most * sizeof(Instance));
    gpu::VertexArray& layout = made.layout_[kind] = gpu::VertexArray::make();
    layout.source(made.vertices_, sizeof(MarkerVertex));
    layout.floats(0, 3, offsetof(MarkerVertex, position));
    layout.floats(1, 3, offsetof(MarkerVertex, normal));
    layout.source(made.instances_[kind], sizeof(Instance), 1);
    layout.floats(2, 4, offsetof(Instance, row_x));
    layout.floats(3, 4, offsetof(Instance, row_y));
    layout.floats(4, 4, offsetof(Instance, row_z));
    layout.floats(5, 4, offsetof(Instance, tint));
    layout.indices(made.indices_);
  }
  return made;
}

void Markers::take(const std::vector<ProbeSnapshot>& probes) {
  for (const ProbeSnapshot& now : probes)
    for (Known& probe : probes_)
      if (probe.entity == now.probe) {
        probe.placed = true;
        probe.position = now.position;
        probe.force = now.force;
        probe.normal = now.normal;
        probe.rotation = now.rotation;
        probe.contact_count = now.contact_count;
        probe.contacts = now.contacts;
      }
}

void Markers::take(const SoftSnapshot& snapshot) {
  const auto first = [](const auto& all, std::size_t count, std::size_t most) {
    return all.begin() + static_cast<std::ptrdiff_t>(std::min({count, all.size(), most}));
  };
  contacts_.assign(snapshot.contacts.begin(), first(snapshot.contacts, snapshot.contact_count, most_contacts_));
  handles_.assign(snapshot.handles.begin(), first(snapshot.handles, snapshot.handles.size(), most_handles_));
}

// The outward direction at a probe: along the force while it presses, else along the normal of the ellipsoid inscribed
// in the nearest surface's box. The two are blended, so that a stylus does not jump at first touch.
vec3 Markers::outward(const Known& probe) const {
  const vec3 p(probe.position);
  const Box* nearest = nullptr;
  float least = std::numeric_limits<float>::max();
  for (const Box& box : boxes_) {
    const float distance = box.empty() ? least : length(p - glm::clamp(p, box.min, box.max));
    if (distance < least) nearest = &box, least = distance;
  }
  vec3 out(0, 1, 0);
  if (nearest) {
    const vec3 half = glm::max(0.5f * nearest->size(), vec3(0.02f * diagonal_));
    const vec3 slope = (p - nearest->center()) / (half * half);
    if (length(slope) > 1e-6f) out = normalize(slope);
  }
  const float newtons = static_cast<float>(length(probe.force));
  if (newtons > 0) out = glm::mix(out, vec3(probe.force) / newtons, glm::smoothstep(0.0f, 0.2f, newtons));
  return length(out) > 1e-6f ? normalize(out) : vec3(0, 1, 0);
}

// A unit shape stretched from `from` to `to` along its y axis; a ball is centred at `from`, with to - from as its
// radius.
void Markers::place(Kind kind, vec3 from, vec3 to, float radius, vec3 color, float roughness) {
  const vec3 along = to - from;
  const vec3 y = normalize(along);
  const vec3 x = normalize(cross(std::abs(y.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), y)), z = cross(x, y);
  const mat3 turned(radius * x, along, radius * z);
  auto row = [&](int i) { return vec4(turned[0][i], turned[1][i], turned[2][i], from[i]); };
  placed_[kind].push_back({row(0), row(1), row(2), vec4(color, roughness)});
}

void Markers::lay_out_probe(const Known& probe, vec3 ball, float radius, const Viewpoint& viewpoint) {
  const vec3 out = outward(probe);
  const ProbePart& only = probe.parts.front();
  if (probe.parts.size() > 1 || !only.is_sphere() || only.from != dvec3(0)) return lay_out_parts(probe, radius);
  place(kBall, ball, ball + radius * out, radius, probe.color, 0.25f);
  // The stylus leans away from the arrow, clockwise as seen, and upwards the more the arrow points at the eye, so that
  // both are distinguishable. It leans elsewhere if it would cover the arrow of one of several contacts.
  const vec3 forward = normalize(vec3(viewpoint.target - viewpoint.eye)), right = cross(forward, out);
  const vec3 up = normalize(vec3(viewpoint.up)), both = right + (1.0f - length(right)) * up;
  const vec3 aside = both / std::max(length(both), kSteadyLean);
  const auto leaning = [&](vec3 to) { return normalize(std::cos(kLean) * out + std::sin(kLean) * to + 0.2f * up); };
  const auto covers = [&](vec3 lean) {
    for (std::uint32_t i = 0; i < probe.contact_count && probe.contact_count > 1; ++i)
      if (dot(lean, vec3(probe.contacts[i].force)) > kCovered * length(vec3(probe.contacts[i].force))) return true;
    return false;
  };
  vec3 lean = leaning(aside);
  for (const vec3 to : {-aside, forward, -forward})
    if (covers(lean)) lean = leaning(to);
  place(kRod, ball, ball + (radius + kRodLength * diagonal_) * lean, kRodRadius * radius, kRodColor, 0.35f);
}

// A ball at every sphere, and a capsule's shaft between its two balls.
void Markers::lay_out_parts(const Known& probe, float radius) {
  const vec3 up(probe.rotation * dvec3(0, 1, 0));
  const auto at = [&](dvec3 place) { return vec3(probe.position + probe.rotation * place); };
  const auto ball = [&](vec3 center) { place(kBall, center, center + radius * up, radius, probe.color, 0.25f); };
  for (const ProbePart& part : probe.parts) {
    ball(at(part.from));
    if (part.is_sphere()) continue;
    ball(at(part.to));
    place(kRod, at(part.from), at(part.to), radius, kRodColor, 0.35f);
  }
}

// An arrow at `from` along the force; its length is proportional to the force, up to a limit.
void Markers::lay_out_arrow(vec3 from, vec3 force, float thickness) {
  const float newtons = length(force);
  if (!(newtons >= kSmallestForce)) return;
  const vec3 direction = force / newtons;
  const vec3 neck = from + std::min(kArrowPerNewton * newtons, kLongestArrow) * diagonal_ * direction;
  place(kRod, from, neck, thickness * kArrowRadius * diagonal_, kArrowColor, 0.5f);
  place(kHead, neck, neck + thickness * kHeadLength * diagonal_ * direction, thickness * kHeadRadius * diagonal_,
        kArrowColor, 0.5f);
}

void Markers::lay_out_force(const Known& probe, vec3 ball, float radius) {
  // With several contacts, also each one's force, from the far side of its tip.
  for (std::uint32_t i = 0; i < probe.contact_count && probe.contact_count > 1; ++i) {
    const vec3 own(probe.contacts[i].force);
    if (length(own) >= kSmallestForce)
      lay_out_arrow(vec3(probe.contacts[i].position) + 2.0f * radius * normalize(own), own, kThinArrow);
  }
  const vec3 force(probe.force);
  if (length(force) >= kSmallestForce) lay_out_arrow(ball + radius * normalize(force), force, 1.0f);
}

void Markers::lay_out_axes(vec3 from, const mat3& axes) {
  for (int i = 0; i < 3; ++i)
    place(kRod, from, from + kFrameLength * diagonal_ * axes[i], kFrameRadius * diagonal_, kFrameColors[i], 0.6f);
}

// At the probe's lowest point: tangents in red and blue, the normal in green.
void Markers::lay_out_frame(const Known& probe) {
  if (length(probe.normal) < 0.5) return;
  const vec3 y(normalize(probe.normal));
  const vec3 x = normalize(cross(std::abs(y.z) < 0.9f ? vec3(0, 0, 1) : vec3(1, 0, 0), y));
  lay_out_axes(vec3(probe.position) - probe.radius * y, mat3(x, y, cross(x, y)));
}

// The contact's normal, in another colour while it slides, and its force.
void Markers::lay_out_contact(const ContactMark& contact) {
  if (!(length(contact.normal) > 0.5f)) return;
  place(kRod, contact.position, contact.position + kNormalLength * diagonal_ * contact.normal,
        kNormalRadius * diagonal_, contact.sliding ? kSlidingColor : kStickingColor, 0.6f);
  lay_out_arrow(contact.position, contact.force, kThinArrow);
}

// The handle's frame, and the coupling: from its centre to the device's target.
void Markers::lay_out_handle(const HandleMark& handle) {
  lay_out_axes(handle.middle, mat3(glm::mat4_cast(quat(handle.pose.rotation))));
  if (length(handle.wanted - handle.middle) > kShortestCoupling * diagonal_)
    place(kRod, handle.middle, handle.wanted, kFrameRadius * diagonal_, kCouplingColor, 0.6f);
  const float ball = kWantedBall * diagonal_;
  place(kRod, handle.wanted - vec3(0, ball, 0), handle.wanted + vec3(0, ball, 0), ball, kCouplingColor, 0.6f);
  lay_out_arrow(handle.middle, handle.force, 1.0f);
}

std::size_t Markers::upload(const Viewpoint& viewpoint, const RenderOptions& options) {
  for (std::vector<Instance>& kind : placed_) kind.clear();
  for (const Known& probe : probes_) {
    if (!probe.placed) continue;
    // A ball drawn larger than the probe has the same lowest point.
    const float radius = std::max(probe.radius, kSmallestBall * diagonal_);
    const vec3 ball = vec3(probe.position) + (radius - probe.radius) * outward(probe);
    if (options.markers) lay_out_probe(probe, ball, radius, viewpoint);
    if (options.markers && options.forces) lay_out_force(probe, ball, radius);
    if (options.contact_frames) lay_out_frame(probe);
  }
  if (options.contacts)
    for (const ContactMark& contact : contacts_) lay_out_contact(contact);
  if (options.handles)
    for (const HandleMark& handle : handles_) lay_out_handle(handle);
  changed_ = placed_[kBall] != balls_before_;
  balls_before_ = placed_[kBall];
  std::size_t travelled = 0;
  for (unsigned kind = 0; kind < kKinds; ++kind)
    travelled += instances_[kind].write(0, placed_[kind].data(), placed_[kind].size() * sizeof(Instance));
  return travelled;
}

void Markers::draw_kind(Kind kind) const {
  glBindVertexArray(layout_[kind].id());
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(shapes_[kind].index_count), GL_UNSIGNED_INT,
                          reinterpret_cast<const void*>(shapes_[kind].first_index * sizeof(std::uint32_t)),
                          static_cast<GLsizei>(placed_[kind].size()));
}

void Markers::draw() const {
  program_.use();
  glFrontFace(GL_CCW);
  glEnable(GL_CULL_FACE);
  for (const Kind kind : {kBall, kRod, kHead}) draw_kind(kind);
}

std::uint32_t Markers::balls(std::span<vec4> balls) const {
  const std::size_t count = std::min(balls.size(), placed_[kBall].size());
  for (std::size_t i = 0; i < count; ++i) {
    const Instance& ball = placed_[kBall][i];
    balls[i] = {ball.row_x.w, ball.row_y.w, ball.row_z.w, length(vec3(ball.row_x.x, ball.row_y.x, ball.row_z.x))};
  }
  return static_cast<std::uint32_t>(count);
}

void Markers::draw_shadow() const {
  shadow_.use();
  draw_kind(kBall);
}

}  // namespace pliant
