#include "editor/viewport/solid_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "editor/viewport/signs.h"
#include "editor/viewport/view_camera.h"

namespace pliant {
namespace {

constexpr float kEncode = 1.0f / 2.2f;
constexpr std::size_t kMostNormals = 20'000;          // more lines than that hide the mesh
constexpr std::size_t kMostDots = 30'000;             // of what is pinned
constexpr double kSignReach = 9.0, kLineReach = 5.0;  // [pixel] picking distance of a symbol's position, and of its
                                                      // lines

struct SolidVertex {
  vec3 position, normal;
};

std::vector<SolidVertex> vertices_of(const Primitive& primitive) {
  std::vector<SolidVertex> out(primitive.position.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {primitive.position[i], vec3(0)};
  if (primitive.normal.size() == out.size()) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].normal = primitive.normal[i];
    return out;
  }
  for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3) {
    const std::uint32_t a = primitive.index[t], b = primitive.index[t + 1], c = primitive.index[t + 2];
    const vec3 n = cross(out[b].position - out[a].position, out[c].position - out[a].position);
    for (const std::uint32_t v : {a, b, c}) out[v].normal += n;
  }
  for (SolidVertex& v : out) v.normal = dot(v.normal, v.normal) > 0.0f ? glm::normalize(v.normal) : vec3(0, 1, 0);
  return out;
}

vec3 encoded(vec3 linear) {
  return glm::pow(glm::clamp(linear, vec3(0), vec3(1)), vec3(kEncode));
}

}  // namespace

double grid_step(const Viewpoint& view, double orthographic) {
  const double seen = orthographic > 0.0
                          ? orthographic
                          : 2.0 * length(view.target - view.eye) * std::tan(0.5 * static_cast<double>(view.yfov));
  return std::pow(10.0, std::floor(std::log10(std::max(seen, 1e-12) / 4.0)));
}

bool same_scene(const SolidOrder& a, const SolidOrder& b) {
  const auto view = [](const SolidOrder& o) {
    return std::tuple(o.view.eye, o.view.target, o.view.up, o.view.yfov, o.orthographic, o.above, o.below, o.grid,
                      o.axis[0], o.axis[1], o.axis[2], o.sign, o.selected_color);
  };
  return view(a) == view(b) && a.settings == b.settings && a.selected == b.selected && a.lines == b.lines &&
         a.creases == b.creases && a.state.nodes == b.state.nodes && a.state.meshes == b.state.meshes &&
         a.state.rest == b.state.rest && a.state.paint == b.state.paint;
}

mat4 clip_from_world(const Viewpoint& view, double orthographic, double aspect, const Box& box) {
  const dmat4 eye = glm::lookAt(view.eye, view.target, view.up);
  double nearest = 1e30, farthest = 0.0;
  if (!box.empty())
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                    corner & 4 ? box.max.z : box.min.z);
      const double depth = -dvec3(eye * glm::dvec4(p, 1.0)).z;
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  const double away = std::max(length(view.target - view.eye), 1e-12);
  farthest = std::max(1.1 * farthest, 4.0 * away);
  if (orthographic > 0.0) {
    const double h = 0.5 * orthographic, w = h * aspect;
    return mat4(glm::ortho(-w, w, -h, h, std::min(nearest, 0.0) - farthest, farthest) * eye);
  }
  nearest = std::clamp(0.5 * nearest, std::min(std::max(1e-3 * away, 1e-5 * farthest), 0.5 * away), 0.5 * away);
  return mat4(glm::perspective(static_cast<double>(view.yfov), aspect, nearest, farthest) * eye);
}

Result<SolidView> SolidView::make() {
  SolidView view;
  if (Status s = view.reload(); !s) return s.error();
  view.empty_ = gpu::VertexArray::make();
  return view;
}

Status SolidView::reload() {
  Result<gpu::Program> solid = gpu::Program::load({"editor_solid.vert", "editor_solid.frag"});
  if (!solid) return solid.error();
  Result<gpu::Program> lines = gpu::Program::load({"editor_lines.vert", "editor_lines.frag"});
  if (!lines) return lines.error();
  Result<gpu::Program> screen = gpu::Program::load({"editor_screen.vert", "editor_screen.frag"});
  if (!screen) return screen.error();
  solid_ = *std::move(solid);
  lines_program_ = *std::move(lines);
  screen_ = *std::move(screen);
  drawn_ = false;
  return Done{};
}

SolidView::MeshOnGpu& SolidView::on_gpu(const std::shared_ptr<const DocumentMesh>& mesh) {
  MeshOnGpu& out = meshes_[mesh.get()];
  out.seen = true;
  if (out.of) return out;
  out.of = mesh;
  for (const Primitive& primitive : mesh->primitives) {
    PrimitiveOnGpu p;
    const std::vector<SolidVertex> vertices = vertices_of(primitive);
    p.index_count = static_cast<GLsizei>(primitive.index.size());
    p.vertices = gpu::Buffer::fixed<SolidVertex>(vertices);
    p.indices = gpu::Buffer::fixed<std::uint32_t>(primitive.index);
    p.layout = gpu::VertexArray::make();
    p.layout.source(0, p.vertices, sizeof(SolidVertex));
    p.layout.floats(0, 0, 3, 0);
    p.layout.floats(1, 0, 3, sizeof(vec3));
    p.layout.indices(p.indices);
    out.primitives.push_back(std::move(p));
  }
  return out;
}

void SolidView::add_edges(PrimitiveOnGpu& to, const Primitive& primitive) {
  if (to.edge_count != 0 || primitive.index.empty()) return;
  std::vector<std::uint64_t> edges;
  edges.reserve(primitive.index.size());
  for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = primitive.index[t + i], b = primitive.index[t + (i + 1) % 3];
      edges.push_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * edges.size());
  double sum = 0;
  for (const std::uint64_t edge : edges) {
    ends.push_back(static_cast<std::uint32_t>(edge >> 32));
    ends.push_back(static_cast<std::uint32_t>(edge));
    sum += static_cast<double>(length(primitive.position[ends.back()] - primitive.position[ends[ends.size() - 2]]));
  }
  to.mean_edge = sum / static_cast<double>(edges.size());
  to.edge_count = static_cast<GLsizei>(ends.size());
  to.edges = gpu::Buffer::fixed<std::uint32_t>(ends);
  to.edge_layout = gpu::VertexArray::make();
  to.edge_layout.source(0, to.vertices, sizeof(SolidVertex));
  to.edge_layout.floats(0, 0, 3, 0);
  to.edge_layout.floats(1, 0, 3, sizeof(vec3));
  to.edge_layout.indices(to.edges);
}

void SolidView::add_normals(MeshOnGpu& mesh) {
  if (mesh.has_normals) return;
  mesh.has_normals = true;
  const float normal_length = 0.012f * mesh.of->box.diagonal();
  std::size_t vertex_count = 0;
  for (const Primitive& primitive : mesh.of->primitives) vertex_count += primitive.position.size();
  const std::size_t every = std::max<std::size_t>(1, vertex_count / kMostNormals);
  for (const Primitive& primitive : mesh.of->primitives) {
    const std::vector<SolidVertex> vertices = vertices_of(primitive);
    for (std::size_t i = 0; i < vertices.size(); i += every) {
      mesh.normal_ends.push_back(vertices[i].position);
      mesh.normal_ends.push_back(vertices[i].position + normal_length * vertices[i].normal);
    }
  }
}

// Dots where the value of pinned or handle is at least one half.
void SolidView::add_regions(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order, const mat4& world,
                            std::vector<LineEnd>& points) {
  for (std::uint32_t i = 0; i < mesh.primitives.size(); ++i)
    for (const int which : {0, 1}) {
      const Channel channel = which == 0 ? Channel::kPinned : Channel::kHandle;
      const auto it = order.state.paint.find({static_cast<std::uint32_t>(number), i, channel});
      if (it == order.state.paint.end()) continue;
      PrimitiveOnGpu& p = mesh.primitives[i];
      const std::vector<vec3>& position = mesh.of->primitives[i].position;
      if (!(p.regions[which] == it->second)) {
        p.regions[which] = it->second;
        p.region_points[which].clear();
        std::vector<vec3> all;
        for (std::size_t v = 0; v < position.size() && v < it->second.size(); ++v)
          if (it->second.value(v) >= 0.5f) all.push_back(position[v]);
        const std::size_t every = 1 + all.size() / kMostDots;
        for (std::size_t v = 0; v < all.size(); v += every) p.region_points[which].push_back(all[v]);
      }
      for (const vec3& at : p.region_points[which])
        points.push_back({vec3(world * vec4(at, 1.0f)), which == 0 ? kPinnedColor : kHandleColor});
    }
}

// Uploads the chunks that differ from the displayed ones.
void SolidView::show_values(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order) {
  if (!order.settings.channel) return;
  for (std::uint32_t i = 0; i < mesh.primitives.size(); ++i) {
    PrimitiveOnGpu& p = mesh.primitives[i];
    const std::size_t count = mesh.of->primitives[i].position.size();
    const auto it = order.state.paint.find({static_cast<std::uint32_t>(number), i, *order.settings.channel});
    const PaintLayer layer =
        it != order.state.paint.end() ? it->second : PaintLayer::constant(count, unpainted(*order.settings.channel));
    if (!p.has_values) {
      p.values = gpu::Buffer::writable(nullptr, layer.chunk_count() * PaintLayer::kChunk * sizeof(float));
      p.layout.source(1, p.values, sizeof(float));
      p.layout.floats(2, 1, 1, 0);
      p.shown = PaintLayer();
      p.has_values = true;
    }
    for (std::size_t c = 0; c < layer.chunk_count(); ++c)
      if (p.shown.chunk_count() != layer.chunk_count() || p.shown.chunk(c) != layer.chunk(c))
        p.values.write(c * PaintLayer::kChunk * sizeof(float), layer.chunk(c), PaintLayer::kChunk * sizeof(float));
    p.shown = layer;
  }
}

void SolidView::make_room(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  const auto texture = [&](GLenum format) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    glTextureStorage2D(id, 1, format, width, height);
    const GLint filter = format == GL_RGBA8 ? GL_LINEAR : GL_NEAREST;
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, filter);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return id;
  };
  color_ = gpu::Object<DestroyTexture>(texture(GL_RGBA8));
  numbers_ = gpu::Object<DestroyTexture>(texture(GL_R32UI));
  depth_ = gpu::Object<DestroyTexture>(texture(GL_DEPTH_COMPONENT32F));
  GLuint frame = 0;
  glCreateFramebuffers(1, &frame);
  frame_ = gpu::Object<DestroyFrame>(frame);
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, color_.id(), 0);
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT1, numbers_.id(), 0);
  glNamedFramebufferTexture(frame, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(frame, 2, both);
}

// Grid lines on the floor, y = 0, at a round spacing suited to the view; they fade out.
void SolidView::add_grid(const SolidOrder& order, std::vector<LineEnd>& ends) {
  if (!order.settings.grid) return;
  const double step = grid_step(order.view, order.orthographic);
  const int half = 30, pieces = 6;
  const double cx = std::round(order.view.target.x / step) * step, cz = std::round(order.view.target.z / step) * step;
  const double far = half * step;
  const auto faded = [&](vec4 c, double x, double z) {
    const double away = std::hypot(x - cx, z - cz) / far;
    c.a *= static_cast<float>(std::clamp(1.0 - away * away, 0.0, 1.0));
    return c;
  };
  for (int i = -half; i <= half; ++i)
    for (const bool along_x : {false, true}) {
      const double place = (along_x ? cz : cx) + i * step, middle = along_x ? cx : cz;
      vec4 tint = order.grid;
      if (std::abs(place) < 0.1 * step)
        tint = vec4(vec3(order.axis[along_x ? 0 : 2]), 0.75f);
      else if (std::abs(std::remainder(place, 10 * step)) >= 0.1 * step)
        tint.a *= 0.45f;
      for (int k = 0; k < pieces; ++k)
        for (const int end : {k, k + 1}) {
          const double on = middle + far * (2.0 * end / pieces - 1.0), x = along_x ? on : place,
                       z = along_x ? place : on;
          ends.push_back({vec3(dvec3(x, 0, z)), faded(tint, x, z)});
        }
    }
}

void SolidView::draw_ends(const std::vector<LineEnd>& ends, const mat4& from_world, bool over, bool points) {
  if (ends.empty()) return;
  line_ends_.write<LineEnd>(ends);
  line_layout_ = gpu::VertexArray::make();
  glVertexArrayVertexBuffer(line_layout_.id(), 0, line_ends_.id(), 0, sizeof(LineEnd));
  line_layout_.floats(0, 0, 3, 0);
  line_layout_.floats(1, 0, 4, sizeof(vec3));
  lines_program_.use();
  glUniformMatrix4fv(0, 1, GL_FALSE, &from_world[0][0]);
  glUniform1f(1, over ? 0.0f : 2e-5f);
  if (over) glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawBuffer(GL_COLOR_ATTACHMENT0);
  glBindVertexArray(line_layout_.id());
  glPointSize(3.0f);
  glDrawArrays(points ? GL_POINTS : GL_LINES, 0, static_cast<GLsizei>(ends.size()));
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, both);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
}

void SolidView::draw_scene(const SolidOrder& order, int width, int height) {
  make_room(width, height);
  const std::vector<dmat4> frames = world_frames(order.state);
  const std::vector<bool> shown = shown_nodes(order.state, order.settings.isolated),
                          selected = at_or_below(order.state, order.selected);
  const Box box = bounds_of(order.state, frames, {});
  const mat4 from_world = clip_from_world(order.view, order.orthographic, static_cast<double>(width) / height, box);
  world_from_clip_ = glm::inverse(from_world);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glViewport(0, 0, width, height);
  const vec4 back = order.below;
  glClearBufferfv(GL_COLOR, 0, &back.x);
  const GLuint none[4] = {0, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 1, none);
  const float far = 1.0f;
  glClearBufferfv(GL_DEPTH, 0, &far);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  std::vector<LineEnd> behind, over, dots;
  add_grid(order, behind);
  draw_ends(behind, from_world, false);
  behind.clear();

  for (auto& [ignored, mesh] : meshes_) mesh.seen = false;
  triangles_ = 0;
  // Selected nodes get the highest numbers, so that one comparison identifies them.
  numbered_.clear();
  std::vector<std::size_t> to_draw;
  for (const bool these : {false, true})
    for (std::size_t i = 0; i < order.state.nodes.size(); ++i)
      if (order.state.nodes[i]->node.mesh >= 0 && shown[i] && selected[i] == these) to_draw.push_back(i);
  first_selected_ = 0xffffffffu;
  const dmat4 eye = glm::lookAt(order.view.eye, order.view.target, order.view.up);
  const mat3 eye_frame{dmat3(eye)};
  const double away = length(order.view.target - order.view.eye);
  const dvec3 forward = (order.view.target - order.view.eye) / away;
  vec4 clip(0);
  if (const ClipPlane& plane = order.settings.clip; plane.on && !box.empty()) {
    const float at = glm::mix(box.min[plane.axis], box.max[plane.axis], static_cast<float>(plane.place));
    clip[plane.axis] = plane.flipped ? -1.0f : 1.0f;
    clip.w = plane.flipped ? -at : at;
  }
  solid_.use();
  glUniformMatrix4fv(0, 1, GL_FALSE, &from_world[0][0]);
  glUniformMatrix3fv(4, 1, GL_FALSE, &eye_frame[0][0]);
  const float low = static_cast<float>(order.settings.value_low), high = static_cast<float>(order.settings.value_high);
  const bool share = order.settings.channel && is_share(*order.settings.channel);
  share ? glUniform2f(6, 0.0f, 1.0f) : glUniform2f(6, std::log2(low), std::log2(high));
  glUniform1i(5, !order.settings.channel ? 0 : share ? 2 : 1);
  glUniform4fv(7, 1, &clip.x);
  glUniform1f(9, 0.0f);
  const auto add = [&](const ViewLine& line) {
    std::vector<LineEnd>& to = line.over ? over : behind;
    to.push_back({line.from, line.color});
    to.push_back({line.to, line.color});
  };
  for (const std::size_t i : to_draw) {
    const DocumentNode& node = *order.state.nodes[i];
    const auto number = static_cast<std::size_t>(node.node.mesh);
    MeshOnGpu& mesh = on_gpu(order.state.meshes[number]);
    show_values(mesh, number, order);
    numbered_.push_back(node.id);
    const auto here = static_cast<GLuint>(numbered_.size());
    if (first_selected_ == 0xffffffffu && selected[i]) first_selected_ = here;
    const mat4 world(frames[i]);
    // The cofactors transform normals like the inverse transpose, and also exist for a scale of 0.
    const dmat3 linear(frames[i]);
    const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
    dmat3 cofactors(side * cross(linear[1], linear[2]), side * cross(linear[2], linear[0]),
                    side * cross(linear[0], linear[1]));
    const double largest = std::max({length(cofactors[0]), length(cofactors[1]), length(cofactors[2])});
    if (largest > 0.0) cofactors /= largest;
    const mat3 normal_frame(cofactors);
    glUniformMatrix4fv(1, 1, GL_FALSE, &world[0][0]);
    glUniformMatrix3fv(2, 1, GL_FALSE, &normal_frame[0][0]);
    glUniform1ui(8, here);
    const Box& own_box = mesh.of->box;
    const dvec3 middle =
        own_box.empty() ? dvec3(frames[i][3]) : dvec3(frames[i] * glm::dvec4(dvec3(own_box.center()), 1.0));
    glFrontFace(glm::determinant(dmat3(frames[i])) < 0.0 ? GL_CW : GL_CCW);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const PrimitiveOnGpu& primitive = mesh.primitives[p];
      const std::int32_t material = mesh.of->primitives[p].material;
      const auto& materials = order.state.rest->materials;
      vec3 base(0.72f, 0.70f, 0.68f);
      if (material >= 0 && static_cast<std::size_t>(material) < materials.size())
        base = glm::max(encoded(vec3(materials[static_cast<std::size_t>(material)].base_color)), vec3(0.18f));
      glUniform3fv(3, 1, &base.x);
      glBindVertexArray(primitive.layout.id());
      // Drawn behind its edges; and a selected surface in front of a coincident one, so that its outline is continuous.
      const bool moved = order.settings.wireframe || selected[i];
      if (moved) {
        glEnable(GL_POLYGON_OFFSET_FILL);
        order.settings.wireframe ? glPolygonOffset(1, 1) : glPolygonOffset(-2, -8);
      }
      glDrawElements(GL_TRIANGLES, primitive.index_count, GL_UNSIGNED_INT, nullptr);
      triangles_ += static_cast<std::size_t>(primitive.index_count) / 3;
      if (moved) glDisable(GL_POLYGON_OFFSET_FILL);
      if (order.settings.wireframe) {
        add_edges(mesh.primitives[p], mesh.of->primitives[p]);
        // Edges about as dense as pixels would hide the surface.
        const double depth = std::max(dot(middle - order.view.eye, forward), 1e-3 * away),
                     pixel = order.orthographic > 0.0
                                 ? order.orthographic / height
                                 : 2.0 * depth * std::tan(0.5 * static_cast<double>(order.view.yfov)) / height;
        const double apart = primitive.mean_edge * std::cbrt(std::abs(glm::determinant(linear))) / pixel;
        glUniform1f(9, 1.0f);
        glUniform4f(10, 0.04f, 0.06f, 0.09f, static_cast<float>(std::clamp(apart / 10.0, 0.06, 0.8)));
        glEnablei(GL_BLEND, 0);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glBindVertexArray(primitive.edge_layout.id());
        glDrawElements(GL_LINES, primitive.edge_count, GL_UNSIGNED_INT, nullptr);
        glDisablei(GL_BLEND, 0);
        glUniform1f(9, 0.0f);
      }
    }
    if (order.settings.normals) {
      add_normals(mesh);
      for (std::size_t k = 0; k + 1 < mesh.normal_ends.size(); k += 2)
        add({vec3(world * vec4(mesh.normal_ends[k], 1)), vec3(world * vec4(mesh.normal_ends[k + 1], 1)),
             vec4(0.35f, 0.75f, 0.95f, 1.0f), false});
    }
    if (const auto creases = order.creases.find(order.state.meshes[number].get());
        order.settings.creases && creases != order.creases.end() && creases->second)
      for (std::size_t k = 0; k + 1 < creases->second->size(); k += 2)
        add({vec3(world * vec4((*creases->second)[k], 1)), vec3(world * vec4((*creases->second)[k + 1], 1)),
             vec4(0.98f, 0.86f, 0.30f, 1.0f), false});
    if (order.settings.regions) add_regions(mesh, number, order, world, dots);
  }
  glFrontFace(GL_CCW);
  signs_.clear();
  std::vector<ViewLine> lines = order.lines;
  add_signs(order, frames, shown, selected, {order.sign, order.selected_color, kPinnedColor, kHandleColor}, lines,
            signs_);
  for (const ViewLine& line : lines) add(line);
  draw_ends(behind, from_world, false);
  draw_ends(dots, from_world, false, true);
  draw_ends(over, from_world, true);
  std::erase_if(meshes_, [](const auto& each) { return !each.second.seen; });
}

void SolidView::draw(const SolidOrder& order, GLuint framebuffer, int width, int height) {
  if (!drawn_ || width != width_ || height != height_ || !same_scene(order, last_)) {
    draw_scene(order, width, height);
    last_ = order;
    drawn_ = true;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  screen_.use();
  glBindTextureUnit(0, color_.id());
  glBindTextureUnit(1, numbers_.id());
  glUniform1i(0, 0);
  glUniform1i(1, 1);
  glUniform4fv(2, 1, &order.selected_color.x);
  glUniform4fv(3, 1, &order.hovered_color.x);
  const auto hovered = std::find(numbered_.begin(), numbered_.end(), order.hovered);
  glUniform1ui(4, order.hovered == kNoNode || hovered == numbered_.end()
                      ? 0
                      : static_cast<GLuint>(hovered - numbered_.begin()) + 1);
  glUniform1ui(5, first_selected_);
  glUniform1i(6, height > 1600 ? 2 : 1);
  glBindVertexArray(empty_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

SolidPicked SolidView::pick(double x, double y, double pixel) const {
  const int px = static_cast<int>(x), py = height_ - 1 - static_cast<int>(y);
  if (px < 0 || py < 0 || px >= width_ || py >= height_) return {};
  // Symbols are drawn on top and are thin: the nearest one within reach is picked.
  const double scale = pixel * std::max(1.0, height_ / (1080.0 * pixel));
  double nearest = 1.0;  // [1] of the reach
  SolidPicked sign;
  const auto on = [&](dvec3 place) { return on_picture(last_.view, last_.orthographic, width_, height_, place); };
  const auto consider = [&](const ViewSign& of, double away, double reach) {
    if (away >= nearest * reach * scale) return;
    nearest = away / (reach * scale);
    sign = {of.node, of.place};
  };
  for (const ViewSign& each : signs_) {
    if (const auto at = on(each.place)) consider(each, std::hypot(at->x - x, at->y - y), kSignReach);
    for (const auto& [from, to] : each.lines) {
      const auto a = on(dvec3(from)), b = on(dvec3(to));
      if (!a || !b) continue;
      const dvec2 along = dvec2(*b) - dvec2(*a), off = dvec2(x, y) - dvec2(*a);
      const double square = dot(along, along);
      consider(each, length(off - (square > 0.0 ? std::clamp(dot(off, along) / square, 0.0, 1.0) : 0.0) * along),
               kLineReach);
    }
  }
  if (sign.node != kNoNode) return sign;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  GLuint number = 0;
  float depth = 1.0f;
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(px, py, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, &number);
  glReadPixels(px, py, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  if (number == 0 || number > numbered_.size()) return {};
  const glm::dvec4 at =
      glm::dmat4(world_from_clip_) * glm::dvec4(2.0 * (px + 0.5) / width_ - 1.0, 2.0 * (py + 0.5) / height_ - 1.0,
                                                2.0 * static_cast<double>(depth) - 1.0, 1.0);
  return {numbered_[number - 1], dvec3(at) / at.w};
}

}  // namespace pliant
