// The editor's own picture of a document: meshes with plain lighting, painted values as colour, the selection outlined.
// It follows the document immediately; the final appearance is the renderer's. Needs a current OpenGL 4.5 context.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "editor/viewport/frames.h"
#include "editor/viewport/view_settings.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/renderer.h"

namespace pliant {

// A line in the world, on top of everything (`over`) or depth-tested.
struct ViewLine {
  vec3 from{0}, to{0};  // [m] world
  vec4 color{1};        // encoded
  bool over = false;
  bool operator==(const ViewLine&) const = default;
};

struct SolidOrder {
  State state;
  Viewpoint view;
  double orthographic = 0.0;  // [m] height of the view; 0: perspective
  ViewSettings settings;
  std::vector<NodeId> selected;
  NodeId hovered = kNoNode;
  std::vector<ViewLine> lines;
  // [m] mesh frame, pairs of ends; null or absent: unknown yet.
  std::map<const DocumentMesh*, std::shared_ptr<const std::vector<vec3>>> creases;
  // [m] effect's frame: corners of the path that it guides along, by file; null or absent: unknown yet.
  std::map<std::string, std::shared_ptr<const std::vector<vec3>>> guides;
  vec4 above{0}, below{0}, grid{0};          // colours of the background and grid, encoded
  vec4 selected_color{0}, hovered_color{0};  // encoded
  vec4 axis[3]{}, sign{0};                   // of the grid's axes; of signs of nodes, encoded
};

// Position of a node without a surface, and its symbol's lines.
struct ViewSign {
  NodeId node = kNoNode;
  dvec3 place{0};                            // [m] world
  std::vector<std::pair<vec3, vec3>> lines;  // [m] world
};

// The object at a pixel.
struct SolidPicked {
  NodeId node = kNoNode;  // none: nothing
  dvec3 point{0};         // [m] world
};

class SolidView {
 public:
  static Result<SolidView> make();
  Status reload();  // its shaders; after an error the old ones are kept

  // Into `framebuffer`, which has width x height pixels. An unchanged picture is not drawn again.
  void draw(const SolidOrder& order, GLuint framebuffer, int width, int height);
  // In the last picture; pixels count from the upper left corner. `pixel`: picture pixels per displayed pixel.
  SolidPicked pick(double x, double y, double pixel = 1.0) const;
  std::size_t triangles() const { return triangles_; }  // drawn last

 private:
  struct PrimitiveOnGpu {
    gpu::Buffer vertices, indices, edges;
    gpu::VertexArray layout, edge_layout;
    GLsizei index_count = 0, edge_count = 0;  // of edges: ends; 0: not made yet
    double mean_edge = 0.0;                   // [m] mesh frame
    PaintLayer shown;                         // content of `values`
    PaintLayer regions[2];                    // pinned, handle: those shown by `region_points`
    std::vector<vec3> region_points[2];       // [m] mesh frame
    gpu::Buffer values;
    bool has_values = false;
  };
  struct MeshOnGpu {
    std::shared_ptr<const DocumentMesh> of;  // kept alive, so that its address stays unique
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
  struct Scene;
  void draw_scene(const SolidOrder& order, int width, int height);
  void clear(const SolidOrder& order, int width, int height);
  void draw_meshes(Scene& scene);
  void set_up_surfaces(const Scene& scene);
  // Of node `i`.
  void draw_surfaces(const Scene& scene, std::size_t i, MeshOnGpu& mesh);
  void draw_edges(const Scene& scene, std::size_t i, MeshOnGpu& mesh, std::size_t primitive);
  static void add_overlays(Scene& scene, std::size_t i, MeshOnGpu& mesh);
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
  std::vector<NodeId> numbered_;  // node of number - 1, in the last picture
  std::uint32_t first_selected_ = 0xffffffffu;
  mat4 world_from_clip_{1};
  std::vector<ViewSign> signs_;  // of the last picture, for picking
  SolidOrder last_;
  bool drawn_ = false;
};

// clip_from_world of a view; `box` [m] world must lie between near and far.
mat4 clip_from_world(const Viewpoint& view, double orthographic, double aspect, const Box& box);
// [m] between the grid's lines, a power of ten suited to the view.
double grid_step(const Viewpoint& view, double orthographic);
// Whether both orders give the same picture, except for hovering.
bool same_scene(const SolidOrder& a, const SolidOrder& b);

}  // namespace pliant
