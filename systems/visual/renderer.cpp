#include "systems/visual/renderer.h"

#include <algorithm>

#include "runtime/clock.h"
#include "systems/visual/environment.h"
#include "systems/visual/gpu/desktop.h"
#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/gpu/scene_texture.h"
#include "systems/visual/marker.h"
#include "systems/visual/nearby.h"
#include "systems/visual/picking.h"
#include "systems/visual/shadow.h"
#include "systems/visual/surface.h"
#include "systems/visual/tet_lines.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr int kSamples = 4;      // per pixel
constexpr float kPlain = 0.08f;  // [1] linear grey, if the surroundings are not shown

std::uint32_t modes_of(const RenderOptions& options) {
  return (options.reflection ? kReflectionMode : 0u) | (options.refraction ? kRefractionMode : 0u) |
         (options.bump ? kBumpMode : 0u) | (options.zones ? kZoneMode : 0u);
}

// Lines hide nothing.
std::uint32_t modes_of(PictureQuality quality, const RenderOptions& options) {
  if (quality == PictureQuality::kLow) return 0;
  std::uint32_t modes = kSteadyMode | (options.background ? kGroundMode : 0u);
  if (options.shadows && !options.wireframe) modes |= kOccludedMode;
  if (quality == PictureQuality::kHigh && (modes & kOccludedMode)) modes |= kContactMode;
  return modes;
}

}  // namespace

struct Renderer::Parts {
  RenderOptions options;
  Box scene;  // [m] world
  Surroundings surroundings;
  Surfaces surfaces;
  Markers markers;
  TetLines tetrahedra;
  gpu::Program background, encode;  // `encode` in OpenGL ES
  gpu::VertexArray nothing;         // the background's vertices are computed from their index
  gpu::Buffer frame = gpu::Buffer::writable(nullptr, sizeof(FrameConstants));
  gpu::Buffer behind_frame = gpu::Buffer::writable(nullptr, sizeof(FrameConstants));
  gpu::Framebuffer samples, picture;
  gpu::SceneTexture behind;  // the picture seen through glass
  gpu::Texture blank = gpu::Texture::constant(0, 0, 0);
  bool through = false;  // this picture contains glass
  NearbyLight nearby;
  std::uint32_t modes = 0;  // ModeBits of this picture
  Shadow shadow;
  bool shaded = false;     // this picture has a shadow
  bool shadow_old = true;  // the map is out of date
  mat4 lamp_view{0};       // of the newest picture, like clip_from_world
  mat4 clip_from_world{1};
  Picking picking;
  std::optional<PickQuestion> question;

  void measure_scene();
  std::size_t upload(const Viewpoint& viewpoint, int width, int height);
  bool draw_shadow();
  void draw_behind(int width, int height);
  void draw_scene(vec3 eye);
  void show_in(std::uint32_t target, int width, int height);
  FrameStats render(const Viewpoint& viewpoint, int width, int height);
};

void Renderer::Parts::measure_scene() {
  scene = surfaces.box();
  if (scene.empty()) scene.add(Box{vec3(-0.5f), vec3(0.5f)});
}

// Uploads everything that this picture needs; returns the bytes uploaded.
std::size_t Renderer::Parts::upload(const Viewpoint& viewpoint, int width, int height) {
  measure_scene();
  FrameConstants constants;
  const mat4 projection = projection_of(viewpoint, scene, static_cast<float>(width) / static_cast<float>(height));
  const mat4 view = view_of(viewpoint);
  constants.view_projection = projection * view;
  constants.inverse_view_projection = glm::inverse(constants.view_projection);
  constants.eye = vec4(vec3(viewpoint.eye), 1);
  surroundings.light(constants);
  constants.picture.z = options.tint_height > 0 ? 1 / options.tint_height : 0;
  constants.modes.y = modes = modes_of(options) | modes_of(options.quality, options);
  nearby.place(scene, projection, view, constants);
  if (shadow.place(constants.lamps[0], scene, constants) && options.shadows) constants.modes.y |= kShadowMode;
  shaded = constants.modes.y & kShadowMode;
  std::size_t travelled = surfaces.upload() + markers.upload(viewpoint, options);
  if (options.markers && options.shadows) constants.modes.z = markers.balls(constants.balls);
  if (options.tetrahedra) travelled += tetrahedra.upload();
  through = options.refraction && surfaces.has_glass();
  if (through) {
    constants.modes.y |= kLinearMode;
    travelled += behind_frame.write(0, &constants, sizeof constants);
    constants.modes.y ^= kLinearMode | kBehindMode;
  }
  travelled += frame.write(0, &constants, sizeof constants);
  shadow_old = shadow_old || surfaces.changed() || markers.changed() || constants.shadow_from_world != lamp_view;
  lamp_view = constants.shadow_from_world;
  clip_from_world = constants.view_projection;
  return travelled;
}

// The first lamp's view; drawn only if it has changed. Returns whether it was drawn.
bool Renderer::Parts::draw_shadow() {
  shadow.bind(kShadowUnit);
  if (!shaded || !shadow_old) return false;
  shadow.begin();
  surfaces.draw_shadow();
  markers.draw_shadow();
  shadow_old = false;
  return true;
}

// The picture behind glass: everything that is not glass, in linear light, in the same view.
void Renderer::Parts::draw_behind(int width, int height) {
  blank.bind(kBehindUnit);  // not the picture that is being drawn, nor no texture, of which browsers warn
  blank.bind(kBehindDepthUnit);
  if (!through) return;
  if (!behind.has_size(width, height)) behind = gpu::SceneTexture(width, height);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, behind_frame.id());
  behind.begin();
  surfaces.draw_opaque(false);
  markers.draw();
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, frame.id());
  behind.bind_color(kBehindUnit);
  behind.bind_depth(kBehindDepthUnit);
}

// The passes of the visible picture, in order.
void Renderer::Parts::draw_scene(vec3 eye) {
  surfaces.draw_as_lines(options.wireframe);
  surfaces.draw_opaque(true);
  surfaces.draw_as_lines(false);
  markers.draw();

  if (options.background) {
    glDisable(GL_CULL_FACE);
    background.use();
    glBindVertexArray(nothing.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  glEnable(GL_BLEND);
  surfaces.draw_as_lines(options.wireframe);
  surfaces.draw_blended(eye);
  surfaces.draw_as_lines(false);
  glDisable(GL_BLEND);
  if (options.tetrahedra) tetrahedra.draw();
}

FrameStats Renderer::Parts::render(const Viewpoint& viewpoint, int width, int height) {
  if (!samples.has_size(width, height)) {
    samples = gpu::Framebuffer(width, height, kSamples);
    picture = gpu::Framebuffer(width, height, 0);
  }
  FrameStats stats;
  stats.upload_bytes = upload(viewpoint, width, height);
  gpu::desktop::encode_srgb(true);
  gpu::desktop::filter_across_cube_edges();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);  // the background is exactly at the far plane
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, frame.id());
  surroundings.bind();
  if (question) picking.draw(surfaces, clip_from_world, *question);
  question.reset();
  stats.shadow_drawn = draw_shadow();
  if (modes & kOccludedMode) {
    nearby.draw(surfaces, modes & kGroundMode, width, height);
  } else {
    for (const GLuint unit : {kSeenNormalUnit, kSeenDepthUnit, kNearbyUnit}) blank.bind(unit);
  }
  draw_behind(width, height);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, samples.id());
  glViewport(0, 0, width, height);
  glClearColor(kPlain, kPlain, kPlain, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_scene(vec3(viewpoint.eye));
  samples.resolve_into(picture);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE0);
  return stats;
}

// Copies the encoded bytes. Blits of OpenGL ES decode them, and encode them again only in a target that is sRGB.
void Renderer::Parts::show_in(std::uint32_t target, int width, int height) {
  if (!encode.id() || gpu::encodes_srgb(target)) return picture.copy_into(target);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  encode.use();
  picture.bind(gpu::kScratchUnit);
  glBindVertexArray(nothing.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glActiveTexture(GL_TEXTURE0);
}

Renderer::Renderer() : parts_(std::make_unique<Parts>()) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const World& world) {
  std::unique_ptr<Renderer> renderer(new Renderer());
  Parts& parts = *renderer->parts_;
  Result<Surfaces> surfaces = Surfaces::make(world);
  if (!surfaces) return surfaces.error();
  parts.surfaces = *std::move(surfaces);
  if (parts.surfaces.has_glass() && !gpu::SceneTexture(1, 1).complete())
    return Error{"GPU", "does not draw into half-float textures, which glass needs",
                 "enable EXT_color_buffer_float or EXT_color_buffer_half_float"};
  Result<Picking> picking = Picking::make();
  if (!picking) return picking.error();
  parts.picking = *std::move(picking);
  Result<TetLines> tetrahedra = TetLines::make(world);
  if (!tetrahedra) return tetrahedra.error();
  parts.tetrahedra = *std::move(tetrahedra);
  Result<Markers> markers = Markers::make(world, parts.surfaces.boxes());
  if (!markers) return markers.error();
  parts.markers = *std::move(markers);
  Result<gpu::Program> background = gpu::Program::load({"background.vert", "background.frag"});
  if (!background) return background.error();
  parts.background = *std::move(background);
  if (gpu::is_es()) {
    Result<gpu::Program> encode = gpu::Program::load({"screen.vert", "encode.frag"});
    if (!encode) return encode.error();
    parts.encode = *std::move(encode);
  }
  parts.surroundings = Surroundings::make(world);
  parts.shadow = Shadow::make();
  Result<NearbyLight> nearby = NearbyLight::make();
  if (!nearby) return nearby.error();
  parts.nearby = *std::move(nearby);
  parts.nearby.place_ground(parts.surfaces.boxes());
  parts.nothing = gpu::VertexArray::make();
  if (glGetError() == GL_OUT_OF_MEMORY)
    return Error{"GPU", "has no room for this level's meshes and textures", "use a coarser mesh or smaller ones"};
  return renderer;
}

void Renderer::update(const Snapshot& snapshot) {
  for (const ObjectSnapshot& object : snapshot.objects) parts_->surfaces.take(object, snapshot.tick);
  for (const MovedSnapshot& object : snapshot.moved) parts_->surfaces.take(object);
  parts_->markers.take(snapshot.probes);
}

void Renderer::update(const SoftSnapshot& snapshot) {
  for (const SoftObjectSnapshot& object : snapshot.objects) {
    parts_->surfaces.take(object);
    parts_->tetrahedra.take(object);
  }
  parts_->markers.take(snapshot);
}

void Renderer::pick(const PickQuestion& question) {
  parts_->question = question;
}

std::optional<PickAnswer> Renderer::picked(bool wait) {
  return parts_->picking.take(parts_->surfaces, wait);
}

void Renderer::take(World& world) {
  while (world.snapshots->acquire()) update(world.snapshots->read());
  if (world.soft_snapshots && world.soft_snapshots->acquire()) update(world.soft_snapshots->read());
}

RenderOptions& Renderer::options() {
  return parts_->options;
}

FrameStats Renderer::draw(const Viewpoint& viewpoint, std::uint32_t target, int width, int height) {
  const std::uint64_t start = now_ns();
  FrameStats stats = parts_->render(viewpoint, width, height);
  parts_->show_in(target, width, height);
  glFinish();
  stats.draw_ms = static_cast<double>(now_ns() - start) * 1e-6;
  return stats;
}

Image Renderer::picture(const Viewpoint& viewpoint, int width, int height, FrameStats* stats) {
  const std::uint64_t start = now_ns();
  FrameStats drawn = parts_->render(viewpoint, width, height);
  glFinish();
  drawn.draw_ms = static_cast<double>(now_ns() - start) * 1e-6;
  if (stats) *stats = drawn;
  return {.name = "picture",
          .width = static_cast<std::uint32_t>(width),
          .height = static_cast<std::uint32_t>(height),
          .rgba = parts_->picture.read()};
}

}  // namespace pliant
