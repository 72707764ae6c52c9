// The editor's own picture of a document: every mesh where its node stands, plainly lit, with painted values as colour
// and what is selected outlined. It follows the document at once; how a level looks when it is played is the renderer's
// matter. Needs a current OpenGL 4.5 context.
#pragma once

#include <map>
#include <memory>

#include "editor/viewport/view_settings.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/renderer.h"

namespace pliant {

// A line in the world that stands over everything (`over`) or behind what is before it.
struct ViewLine {
  vec3 from{0}, to{0};  // [m] world
  vec4 color{1};        // encoded
  bool over = false;
};

struct SolidOrder {
  State state;
  Viewpoint view;
  double orthographic = 0.0;  // [m] height of what is seen; 0: perspective
  ViewSettings settings;
  std::vector<NodeId> selected;
  NodeId hovered = kNoNode;
  std::vector<ViewLine> lines;
  vec4 above{0}, below{0}, grid{0};          // colours of the background and grid, encoded
  vec4 selected_color{0}, hovered_color{0};  // encoded
};

// What stands at a pixel.
struct SolidPicked {
  NodeId node = kNoNode;  // none: nothing
  dvec3 point{0};         // [m] world
};

class SolidView {
 public:
  static Result<SolidView> make();

  // Into `framebuffer`, which has width x height pixels.
  void draw(const SolidOrder& order, GLuint framebuffer, int width, int height);
  // Of the picture drawn last; pixels count from the upper left corner.
  SolidPicked pick(double x, double y) const;
  std::size_t triangles() const { return triangles_; }  // drawn last

 private:
  struct PrimitiveOnGpu {
    gpu::Buffer vertices, indices;
    gpu::VertexArray layout;
    GLsizei index_count = 0;
    PaintLayer shown;  // what `values` holds
    gpu::Buffer values;
    bool has_values = false;
  };
  struct MeshOnGpu {
    std::shared_ptr<const DocumentMesh> of;  // kept, so that its address stays its own
    std::vector<PrimitiveOnGpu> primitives;
    std::vector<vec3> normal_ends, crease_ends;  // [m] mesh frame, pairs
    bool seen = false;
  };
  MeshOnGpu& on_gpu(const std::shared_ptr<const DocumentMesh>& mesh);
  void show_values(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order);
  void make_room(int width, int height);
  void draw_lines(const SolidOrder& order, const mat4& clip_from_world, bool over);
  void add_grid(const SolidOrder& order, std::vector<ViewLine>& lines) const;

  gpu::Program solid_, lines_program_, screen_;
  std::map<const DocumentMesh*, MeshOnGpu> meshes_;
  gpu::GrowingBuffer line_ends_;
  gpu::VertexArray line_layout_;
  struct DestroyTexture {
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
  };
  struct DestroyFrame {
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
  };
  gpu::Object<DestroyTexture> color_, numbers_, depth_;
  gpu::Object<DestroyFrame> frame_;
  gpu::VertexArray empty_;
  int width_ = 0, height_ = 0;
  std::size_t triangles_ = 0;
  std::vector<NodeId> numbered_;  // node of number - 1, in the picture drawn last
  mat4 world_from_clip_{1};
};

// clip_from_world of a view; `box` [m] world is what must be between near and far.
mat4 clip_from_world(const Viewpoint& view, double orthographic, double aspect, const Box& box);
// [m] world, around all meshes (and the places of nodes without) of a state; `only`: of these and what is below them.
Box bounds_of(const State& state, const std::vector<NodeId>& only = {});
// Of every node, node -> world, in the order of State::nodes.
std::vector<dmat4> world_frames(const State& state);

}  // namespace pliant
