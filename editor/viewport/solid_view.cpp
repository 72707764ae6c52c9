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

vec3 encoded(vec3 linear) {
  return glm::pow(glm::clamp(linear, vec3(0), vec3(1)), vec3(kEncode));
}

}  // namespace

bool same_scene(const SolidOrder& a, const SolidOrder& b) {
  const auto view = [](const SolidOrder& o) {
    return std::tuple(o.view.eye, o.view.target, o.view.up, o.view.yfov, o.orthographic, o.above, o.below, o.grid,
                      o.axis[0], o.axis[1], o.axis[2], o.sign, o.selected_color);
  };
  return view(a) == view(b) && a.settings == b.settings && a.selected == b.selected && a.lines == b.lines &&
         a.creases == b.creases && a.guides == b.guides && a.state.nodes == b.state.nodes &&
         a.state.meshes == b.state.meshes && a.state.looks == b.state.looks && a.state.paint == b.state.paint;
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

// Values of an order that all its meshes share.
struct SolidView::Scene {
  const SolidOrder& order;
  int height = 0;  // [pixel]
  std::vector<dmat4> frames;
  std::vector<bool> shown, selected;
  Box box;
  mat4 from_world{1};
  double away = 0.0;  // [m] of the target
  dvec3 forward{0};
  std::vector<LineEnd> behind, over, dots;

  void add(const ViewLine& line) {
    std::vector<LineEnd>& to = line.over ? over : behind;
    to.push_back({line.from, line.color});
    to.push_back({line.to, line.color});
  }
};

void SolidView::clear(const SolidOrder& order, int width, int height) {
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
}

// Uniforms of the surfaces' shader that hold for the whole scene.
void SolidView::set_up_surfaces(const Scene& scene) {
  const SolidOrder& order = scene.order;
  const dmat4 eye = glm::lookAt(order.view.eye, order.view.target, order.view.up);
  const mat3 eye_frame{dmat3(eye)};
  vec4 clip(0);
  if (const ClipPlane& plane = order.settings.clip; plane.on && !scene.box.empty()) {
    const float at = glm::mix(scene.box.min[plane.axis], scene.box.max[plane.axis], static_cast<float>(plane.place));
    clip[plane.axis] = plane.flipped ? -1.0f : 1.0f;
    clip.w = plane.flipped ? -at : at;
  }
  solid_.use();
  glUniformMatrix4fv(0, 1, GL_FALSE, &scene.from_world[0][0]);
  glUniformMatrix3fv(4, 1, GL_FALSE, &eye_frame[0][0]);
  const float low = static_cast<float>(order.settings.value_low), high = static_cast<float>(order.settings.value_high);
  const bool share = order.settings.channel && is_share(*order.settings.channel);
  share ? glUniform2f(6, 0.0f, 1.0f) : glUniform2f(6, std::log2(low), std::log2(high));
  glUniform1i(5, !order.settings.channel ? 0 : share ? 2 : 1);
  glUniform4fv(7, 1, &clip.x);
  glUniform1f(9, 0.0f);
}

// Edges about as dense as pixels would hide the surface.
void SolidView::draw_edges(const Scene& scene, std::size_t i, MeshOnGpu& mesh, std::size_t p) {
  const SolidOrder& order = scene.order;
  PrimitiveOnGpu& primitive = mesh.primitives[p];
  add_edges(primitive, mesh.of->primitives[p]);
  const dmat4& frame = scene.frames[i];
  const Box& own_box = mesh.of->box;
  const dvec3 middle = own_box.empty() ? dvec3(frame[3]) : dvec3(frame * glm::dvec4(dvec3(own_box.center()), 1.0));
  const double depth = std::max(dot(middle - order.view.eye, scene.forward), 1e-3 * scene.away),
               pixel = order.orthographic > 0.0
                           ? order.orthographic / scene.height
                           : 2.0 * depth * std::tan(0.5 * static_cast<double>(order.view.yfov)) / scene.height;
  const double apart = primitive.mean_edge * std::cbrt(std::abs(glm::determinant(dmat3(frame)))) / pixel;
  glUniform1f(9, 1.0f);
  glUniform4f(10, 0.04f, 0.06f, 0.09f, static_cast<float>(std::clamp(apart / 10.0, 0.06, 0.8)));
  glEnablei(GL_BLEND, 0);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(primitive.edge_layout.id());
  glDrawElements(GL_LINES, primitive.edge_count, GL_UNSIGNED_INT, nullptr);
  glDisablei(GL_BLEND, 0);
  glUniform1f(9, 0.0f);
}

void SolidView::draw_surfaces(const Scene& scene, std::size_t i, MeshOnGpu& mesh) {
  const SolidOrder& order = scene.order;
  const mat4 world(scene.frames[i]);
  // The cofactors transform normals like the inverse transpose, and also exist for a scale of 0.
  const dmat3 linear(scene.frames[i]);
  const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  dmat3 cofactors(side * cross(linear[1], linear[2]), side * cross(linear[2], linear[0]),
                  side * cross(linear[0], linear[1]));
  const double largest = std::max({length(cofactors[0]), length(cofactors[1]), length(cofactors[2])});
  if (largest > 0.0) cofactors /= largest;
  const mat3 normal_frame(cofactors);
  glUniformMatrix4fv(1, 1, GL_FALSE, &world[0][0]);
  glUniformMatrix3fv(2, 1, GL_FALSE, &normal_frame[0][0]);
  glUniform1ui(8, static_cast<GLuint>(numbered_.size()));
  glFrontFace(glm::determinant(linear) < 0.0 ? GL_CW : GL_CCW);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const PrimitiveOnGpu& primitive = mesh.primitives[p];
    const std::int32_t material = mesh.of->primitives[p].material;
    const auto& materials = order.state.materials();
    vec3 base(0.72f, 0.70f, 0.68f);
    if (material >= 0 && static_cast<std::size_t>(material) < materials.size())
      base = glm::max(encoded(vec3(materials[static_cast<std::size_t>(material)].base_color)), vec3(0.18f));
    glUniform3fv(3, 1, &base.x);
    glBindVertexArray(primitive.layout.id());
    // Drawn behind its edges; and a selected surface in front of a coincident one, so that its outline is continuous.
    const bool moved = order.settings.wireframe || scene.selected[i];
    if (moved) {
      glEnable(GL_POLYGON_OFFSET_FILL);
      order.settings.wireframe ? glPolygonOffset(1, 1) : glPolygonOffset(-2, -8);
    }
    glDrawElements(GL_TRIANGLES, primitive.index_count, GL_UNSIGNED_INT, nullptr);
    triangles_ += static_cast<std::size_t>(primitive.index_count) / 3;
    if (moved) glDisable(GL_POLYGON_OFFSET_FILL);
    if (order.settings.wireframe) draw_edges(scene, i, mesh, p);
  }
}

// Normals, creases and painted regions, drawn after all surfaces.
void SolidView::add_overlays(Scene& scene, std::size_t i, MeshOnGpu& mesh) {
  const SolidOrder& order = scene.order;
  const mat4 world(scene.frames[i]);
  const auto number = static_cast<std::size_t>(order.state.nodes[i]->node.mesh);
  const auto add = [&](const std::vector<vec3>& ends, vec4 color) {
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
      scene.add({vec3(world * vec4(ends[k], 1)), vec3(world * vec4(ends[k + 1], 1)), color, false});
  };
  if (order.settings.normals) {
    add_normals(mesh);
    add(mesh.normal_ends, vec4(0.35f, 0.75f, 0.95f, 1.0f));
  }
  if (const auto creases = order.creases.find(order.state.meshes[number].get());
      order.settings.creases && creases != order.creases.end() && creases->second)
    add(*creases->second, vec4(0.98f, 0.86f, 0.30f, 1.0f));
  if (order.settings.regions) add_regions(mesh, number, order, world, scene.dots);
}

// Selected nodes get the highest numbers, so that one comparison identifies them.
void SolidView::draw_meshes(Scene& scene) {
  const SolidOrder& order = scene.order;
  for (auto& [ignored, mesh] : meshes_) mesh.seen = false;
  triangles_ = 0;
  numbered_.clear();
  first_selected_ = 0xffffffffu;
  set_up_surfaces(scene);
  for (const bool these : {false, true})
    for (std::size_t i = 0; i < order.state.nodes.size(); ++i) {
      const DocumentNode& node = *order.state.nodes[i];
      if (node.node.mesh < 0 || !scene.shown[i] || scene.selected[i] != these) continue;
      const auto number = static_cast<std::size_t>(node.node.mesh);
      MeshOnGpu& mesh = on_gpu(order.state.meshes[number]);
      show_values(mesh, number, order);
      numbered_.push_back(node.id);
      if (these && first_selected_ == 0xffffffffu) first_selected_ = static_cast<GLuint>(numbered_.size());
      draw_surfaces(scene, i, mesh);
      add_overlays(scene, i, mesh);
    }
  glFrontFace(GL_CCW);
  std::erase_if(meshes_, [](const auto& each) { return !each.second.seen; });
}

void SolidView::draw_scene(const SolidOrder& order, int width, int height) {
  make_room(width, height);
  Scene scene{order, height, world_frames(order.state), shown_nodes(order.state, order.settings.isolated),
              at_or_below(order.state, order.selected)};
  scene.box = bounds_of(order.state, scene.frames, {});
  scene.from_world = clip_from_world(order.view, order.orthographic, static_cast<double>(width) / height, scene.box);
  scene.away = length(order.view.target - order.view.eye);
  scene.forward = (order.view.target - order.view.eye) / scene.away;
  world_from_clip_ = glm::inverse(scene.from_world);
  clear(order, width, height);
  std::vector<LineEnd> grid;
  add_grid(order, grid);
  draw_ends(grid, scene.from_world, false);
  draw_meshes(scene);
  signs_.clear();
  std::vector<ViewLine> lines = order.lines;
  add_signs(order, scene.frames, scene.shown, scene.selected,
            {order.sign, order.selected_color, kPinnedColor, kHandleColor}, lines, signs_);
  for (const ViewLine& line : lines) scene.add(line);
  draw_ends(scene.behind, scene.from_world, false);
  draw_ends(scene.dots, scene.from_world, false, true);
  draw_ends(scene.over, scene.from_world, true);
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

}  // namespace pliant
