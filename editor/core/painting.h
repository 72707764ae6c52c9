// Shared by the tool and the panel Paint: brush, channel, and all edits of the document. Needs no window.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editor/core/jobs.h"
#include "editor/core/live_stroke.h"
#include "editor/document/state.h"
#include "editor/paint/brush.h"
#include "editor/paint/coarse.h"
#include "editor/paint/paint.h"
#include "viewer/hand/camera_control.h"

namespace pliant {

class Editor;

inline PaintAttribute attribute_of(Channel channel) {
  return static_cast<PaintAttribute>(channel);
}
// The effect of a channel in a sentence, and the key that its factor multiplies.
struct ChannelText {
  const char* title;
  const char* does;
  const char* extension;  // without PLIANT_; the component that uses it
  const char* key;        // the key multiplied by the factor; "": a share
  const char* unit;
};
const ChannelText& text_of(Channel channel);

class Painting {
 public:
  explicit Painting(Editor& editor) : editor_(editor) { brush.radius = 0.0; }

  // --- Brush and channel
  Channel channel = Channel::kStiffness;
  Brush brush;                                    // its value follows from `values` and `amounts`
  double values[6] = {2, 2, 2, 2, 1, 1};          // [1] per channel, the target of Set
  double amounts[6] = {.2, .2, .2, .2, .2, .2};   // [1] per channel, added by a dab of Add; below 0 subtracts
  double gradient_from = 1.0, gradient_to = 3.0;  // [1]
  // The action of the next click on the surface.
  enum class Hand : std::uint8_t { kBrush, kFillPart, kGradientFrom, kGradientTo };
  Hand hand = Hand::kBrush;
  std::optional<SurfaceHit> gradient_start;
  Brush brush_now() const;
  double& value_now() { return values[static_cast<std::size_t>(channel)]; }
  double value_now() const { return values[static_cast<std::size_t>(channel)]; }
  void take_channel(Channel to);
  void scale_radius(double by);
  void fit_radius();  // to the painted object, if it does not fit at all
  void add_strength(double by);

  // --- The painted object: the active node's mesh
  NodeId node() const;  // kNoNode: nothing paintable
  std::shared_ptr<const PaintSurface> surface();
  bool preparing() const;
  double size() const;   // [m] diagonal of the painted object, in the world
  dvec3 corner() const;  // [m] world: origin of the surface frame
  // The visible surface point, considering a clip plane.
  SurfaceHit under(const PaintSurface& surface, const ViewRay& ray) const;
  SurfaceHit mirrored(const PaintSurface& surface,
                      const SurfaceHit& hit) const;  // invalid: no mirror, or no surface there
  double value_at(const PaintSurface& surface, const SurfaceHit& hit) const;
  // "2 x 300 N/m = 600 N/m"; of a share "0.7: held".
  std::string value_text(double value) const;
  std::vector<NodeId> sharing() const;                             // nodes with the same mesh, including this one
  std::string lacks() const;                                       // why the paint has no effect; "": it has
  std::optional<std::pair<double, double>> painted_range() const;  // [1] least and most; empty: unpainted

  // --- A stroke: one step of undo
  void press(const ViewRay& ray, double pressure, BrushMode mode);
  void move(const ViewRay& ray, double pressure);
  void release();
  void give_up();  // undoes the stroke so far
  bool stroking() const { return stroke_ != nullptr; }
  bool working() const { return stroke_ && !stroke_->idle(); }
  // Once per frame: applies the stroke's results to the document.
  void update();

  // --- In the background, one at a time; each is one step of undo
  bool busy() const;  // ... with one of them
  void fill_all();
  void fill_part(const SurfaceHit& at);
  void gradient(const SurfaceHit& from, const SurfaceHit& to);
  void refine(const SurfaceHit& at);
  void make_single();
  void clear();  // the channel; at once

  // --- Where the mesh is too coarse for the brush: detected in the background
  struct Place {
    NodeId node = kNoNode;
    std::shared_ptr<const PaintSurface> surface;
    SurfaceHit hit;
    std::optional<CoarseMesh> coarse;
    double radius = 0.0;  // [m] of the brush that was asked for
  };
  void look_whether_coarse(const SurfaceHit& hit, bool pressed);
  std::optional<Place> hover, pressed;  // `pressed` is reset when the mesh changes

 private:
  std::optional<std::uint32_t> mesh() const;
  Ray seen(const ViewRay& ray) const;  // surface frame, starting at the clip plane
  std::vector<PaintLayer> layers(std::uint32_t mesh) const;
  void change(const std::string& what,
              std::function<PaintChanges(const MeshPaint&, const PaintSurface&, const std::atomic<bool>&)> make);
  void put(const std::string& what, const std::vector<std::pair<std::uint32_t, PaintLayer>>& layers, std::uint32_t mesh,
           Channel channel, const std::string& gesture);
  LevelMesh whole_mesh(std::uint32_t mesh) const;

  Editor& editor_;
  std::unique_ptr<LiveStroke> stroke_;
  struct Under {  // the stroke in progress
    std::shared_ptr<const DocumentMesh> of;
    std::uint32_t mesh = 0;
    Channel channel = Channel::kStiffness;
    std::vector<PaintLayer> shown;  // the document's expected paint
    std::string what, gesture;
    std::size_t step = 0;  // of the document, before it
    bool applied = false;
  } stroking_;
  std::uint64_t strokes_ = 0;
};

}  // namespace pliant
