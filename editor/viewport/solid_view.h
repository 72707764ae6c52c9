// The editor's own picture of a document: every mesh where its node stands, plainly lit, with painted values as colour
// and what is selected outlined. It follows the document at once; how a level looks when it is played is the renderer's
// matter. Needs a current OpenGL 4.5 context.
#pragma once

#include <map>
#include <memory>

#include "editor/viewport/frames.h"
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
  bool operator==(const ViewLine&) const = default;
};

struct SolidOrder {
  State state;
  Viewpoint view;
  double orthographic = 0.0;  // [m] height of what is seen; 0: perspective
  ViewSettings settings;
  std::vector<NodeId> selected;
  NodeId hovered = kNoNode;
  std::vector<ViewLine> lines;
  // [m] mesh frame, pairs of ends; null or absent: not known yet.
  std::map<const DocumentMesh*, std::shared_ptr<const std::vector<vec3>>> creases;
  vec4 above{0}, below{0}, grid{0};          // colours of the background and grid, encoded
  vec4 selected_color{0}, hovered_color{0};  // encoded
  vec4 axis[3]{}, sign{0};                   // of the grid's axes; of signs of nodes, encoded
};

// Where a node without a surface is drawn, and the lines that it is drawn with.
struct ViewSign {
  NodeId node = kNoNode;
  dvec3 place{0};                            // [m] world
  std::vector<std::pair<vec3, vec3>> lines;  // [m] world
};

// What stands at a pixel.
struct SolidPicked {
  NodeId node = kNoNode;  // none: nothing
  dvec3 point{0};         // [m] world
};

class SolidView {
 public:
  static Result<SolidView> make();
  Status reload();  // its shaders; an error leaves those that it has

  // Into `framebuffer`, which has width x height pixels. What has been drawn before is not drawn again.
  void draw(const SolidOrder& order, GLuint framebuffer, int width, int height);
  // Of the picture drawn last; pixels count from the upper left corner. `pixel`: how many of the picture's make one of
  // what is shown.
  SolidPicked pick(double x, double y, double pixel = 1.0) const;
  std::size_t triangles() const { return triangles_; }  // drawn last

 private:
  struct PrimitiveOnGpu {
    gpu::Buffer vertices, indices, edges;
    gpu::VertexArray layout, edge_layout;
    GLsizei index_count = 0, edge_count = 0;  // of edges: ends; 0: not made yet
    double mean_edge = 0.0;                   // [m] mesh frame
    PaintLayer shown;                         // what `values` holds
    PaintLayer regions[2];                    // pinned, handle: that `region_points` show
    std::vector<vec3> region_points[2];       // [m] mesh frame
    gpu::Buffer values;
    bool has_values = false;
  };
  struct MeshOnGpu {
    std::shared_ptr<const DocumentMesh> of;  // kept, so that its address stays its own
    std::vector<PrimitiveOnGpu> primitives;
    std::vector<vec3> normal_ends;  // [m] mesh frame, pairs
    bool seen = false, has_normals = false;
  };
  struct LineEnd {
    vec3 position;
    vec4 tint;
  };
  MeshOnGpu& on_gpu(const std::shared_ptr<const DocumentMesh>& mesh);
  void show_values(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order);
  void make_room(int width, int height);
  void draw_scene(const SolidOrder& order, int width, int height);
  void draw_ends(const std::vector<LineEnd>& ends, const mat4& clip_from_world, bool over, bool points = false);
  static void add_grid(const SolidOrder& order, std::vector<LineEnd>& ends);
  static void add_edges(PrimitiveOnGpu& to, const Primitive& primitive);
  static void add_normals(MeshOnGpu& mesh);
  static void add_regions(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order, const mat4& world,
                          std::vector<LineEnd>& points);

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
  std::uint32_t first_selected_ = 0xffffffffu;
  mat4 world_from_clip_{1};
  std::vector<ViewSign> signs_;  // of the picture drawn last: they are picked, too
  SolidOrder last_;
  bool drawn_ = false;
};

// clip_from_world of a view; `box` [m] world is what must be between near and far.
mat4 clip_from_world(const Viewpoint& view, double orthographic, double aspect, const Box& box);
// [m] between the grid's lines, a power of ten that suits what is seen.
double grid_step(const Viewpoint& view, double orthographic);
// Whether both orders make the same picture, but for what the mouse is over.
bool same_scene(const SolidOrder& a, const SolidOrder& b);

}  // namespace pliant
