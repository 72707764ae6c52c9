// Lines and dots of the solid view, and its grid.
#include <algorithm>
#include <cmath>

#include "editor/viewport/solid_view.h"

namespace pliant {

double grid_step(const Viewpoint& view, double orthographic) {
  const double seen = orthographic > 0.0
                          ? orthographic
                          : 2.0 * length(view.target - view.eye) * std::tan(0.5 * static_cast<double>(view.yfov));
  return std::pow(10.0, std::floor(std::log10(std::max(seen, 1e-12) / 4.0)));
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
  line_layout_.source(line_ends_.buffer(), sizeof(LineEnd));
  line_layout_.floats(0, 3, 0);
  line_layout_.floats(1, 4, sizeof(vec3));
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

}  // namespace pliant
