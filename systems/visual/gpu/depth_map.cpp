#include "systems/visual/gpu/depth_map.h"

namespace pliant::gpu {

DepthMap::DepthMap(int size) : size_(size) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  texture_ = Object<DestroyTexture>(id);
  glTextureStorage2D(id, 1, GL_DEPTH_COMPONENT32F, size, size);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(id, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  GLuint framebuffer = 0;
  glCreateFramebuffers(1, &framebuffer);
  framebuffer_ = Object<DestroyFramebuffer>(framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, id, 0);
  glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
}

void DepthMap::begin() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, size_, size_);
  glClear(GL_DEPTH_BUFFER_BIT);
}

}  // namespace pliant::gpu
