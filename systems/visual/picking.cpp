#include "systems/visual/picking.h"

#include <bit>
#include <glm/gtc/matrix_transform.hpp>

#include "systems/visual/surface.h"

namespace pliant {
namespace {

using Pixel = glm::uvec4;

gpu::Object<gpu::DestroyRenderbuffer> plane_of_one_pixel(GLenum format) {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorage(GL_RENDERBUFFER, format, 1, 1);
  return gpu::Object<gpu::DestroyRenderbuffer>(id);
}

// Maps the pixel to the whole clip cube.
mat4 narrowed(const PickQuestion& q) {
  const float wide = static_cast<float>(q.width), high = static_cast<float>(q.height);
  const float x = 2 * static_cast<float>(q.x) / wide - 1, y = 1 - 2 * static_cast<float>(q.y) / high;
  return glm::scale(mat4(1), vec3(wide, high, 1)) * glm::translate(mat4(1), vec3(-x, -y, 0));
}

dvec3 place_of(const Pixel& p) {
  return dvec3(std::bit_cast<float>(p.y), std::bit_cast<float>(p.z), std::bit_cast<float>(p.w));
}

}  // namespace

Result<Picking> Picking::make() {
  Picking made;
  Result<gpu::Program> program = gpu::Program::load({"pick.vert", "pick.frag"});
  if (!program) return program.error();
  made.program_ = *std::move(program);
  made.clip_from_world_ = glGetUniformLocation(made.program_.id(), "clip_from_world");
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  made.framebuffer_ = gpu::Object<gpu::DestroyFramebuffer>(id);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id);
  GLenum targets[kPlanes];
  for (std::size_t i = 0; i < kPlanes; ++i) {
    targets[i] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    made.planes_[i] = plane_of_one_pixel(GL_RGBA32UI);
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, targets[i], GL_RENDERBUFFER, made.planes_[i].id());
  }
  made.depth_ = plane_of_one_pixel(GL_DEPTH_COMPONENT32F);
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, made.depth_.id());
  glDrawBuffers(kPlanes, targets);
  return made;
}

void Picking::draw(Surfaces& surfaces, const mat4& clip_from_world, const PickQuestion& question) {
  question_ = question;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, 1, 1);
  const GLuint nothing[4] = {};
  for (GLint i = 0; i < static_cast<GLint>(kPlanes); ++i) glClearBufferuiv(GL_COLOR, i, nothing);
  glClear(GL_DEPTH_BUFFER_BIT);
  program_.use();
  const mat4 through_pixel = narrowed(question) * clip_from_world;
  glUniformMatrix4fv(clip_from_world_, 1, GL_FALSE, &through_pixel[0][0]);
  surfaces.hold(question.holds);
  surfaces.draw_as_held();
  written_ = gpu::Fence::here();
}

std::optional<PickAnswer> Picking::take(const Surfaces& surfaces, bool wait) {
  if (!written_.set() || !(wait || written_.passed())) return std::nullopt;
  written_ = gpu::Fence();
  Pixel pixels[kPlanes];
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  for (std::size_t i = 0; i < kPlanes; ++i) {
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    glReadPixels(0, 0, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, &pixels[i]);
  }
  PickAnswer answer{question_, std::nullopt};
  if (const Entity object = surfaces.object(pixels[0].x); object != kNoEntity)
    answer.seen = Picked{object, place_of(pixels[0]), place_of(pixels[1]), normalize(place_of(pixels[2]))};
  return answer;
}

}  // namespace pliant
