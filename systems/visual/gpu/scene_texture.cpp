#include "systems/visual/gpu/scene_texture.h"

namespace pliant::gpu {
namespace {

Object<DestroyTexture> make_plane(GLenum format, int width, int height) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  glTextureStorage2D(id, 1, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Object<DestroyTexture>(id);
}

}  // namespace

SceneTexture::SceneTexture(int width, int height) : width_(width), height_(height) {
  color_ = make_plane(GL_RGBA16F, width, height);
  depth_ = make_plane(GL_DEPTH_COMPONENT32F, width, height);
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  framebuffer_ = Object<DestroyFramebuffer>(id);
  glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT0, color_.id(), 0);
  glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
}

void SceneTexture::begin() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

}  // namespace pliant::gpu
