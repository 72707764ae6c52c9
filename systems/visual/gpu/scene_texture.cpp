#include "systems/visual/gpu/scene_texture.h"

namespace pliant::gpu {

SceneTexture::SceneTexture(int width, int height, GLenum color, bool deep) : width_(width), height_(height) {
  color_ = make_plane(color, width, height);
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  framebuffer_ = Object<DestroyFramebuffer>(id);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
  if (!deep) return;
  depth_ = make_plane(GL_DEPTH_COMPONENT32F, width, height);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
}

bool SceneTexture::complete() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  return glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void SceneTexture::begin() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

}  // namespace pliant::gpu
