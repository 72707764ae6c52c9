// Draws a prepared World on a graphics context: surfaces deformed by P1's two lines, probes and their forces.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "components/appearance.h"
#include "components/snapshot.h"
#include "components/soft_snapshot.h"
#include "components/world.h"
#include "pliant/picture_quality.h"
#include "runtime/result.h"

namespace pliant {

struct FrameStats {
  double draw_ms = 0.0;            // upload and draw until the picture is complete
  std::uint64_t upload_bytes = 0;  // uploaded for this frame (awake zones, vertices of soft bodies, probes, constants)
  bool shadow_drawn = false;       // the lamp's view had changed
};

// Asks for the object at a pixel.
struct PickQuestion {
  double x = 0, y = 0;        // [pixel] from the upper left corner
  int width = 1, height = 1;  // [pixel] of the picture
  std::uint64_t number = 0;   // identifies the answer
  // A soft or rigid body that is being pressed: it is picked in the state in which it was first held. In its current
  // state it would move away from the pointer that presses it.
  Entity holds = kNoEntity;
};

// A place on a surface.
struct Picked {
  Entity object;
  dvec3 point{0};         // [m] world, as drawn: dented, moved
  dvec3 rest{0};          // [m] world, of the same point at rest (of a soft or rigid body: as drawn, or as held)
  dvec3 normal{0, 1, 0};  // [1] world, outward, same state
};

struct PickAnswer {
  PickQuestion question;
  std::optional<Picked> seen;  // empty: the surroundings
};

// Camera of a picture. Chosen from the level's camera or its bounds.
struct Viewpoint {
  dvec3 eye{0, 0, 1};  // [m] world
  dvec3 target{0};     // [m]
  dvec3 up{0, 1, 0};
  float yfov = 0.7f;  // [rad]
};
// The level's first camera, else one that frames every deformable from the front, slightly above. Reads every vertex.
Viewpoint default_viewpoint(const World& world);

// Display options; may change between any two pictures.
struct RenderOptions {
  PictureQuality quality = PictureQuality::kHigh;
  float tint_height = 0.0f;     // [m] height drawn fully blue (in) or red (out); 0: surfaces keep their colours
  bool markers = true;          // probes
  bool forces = true;           // an arrow along each force
  bool contact_frames = false;  // normal and tangents at a probe's contact
  bool background = true;       // the surroundings behind everything; else a plain grey
  bool reflection = true;       // of the surroundings, in every coat
  bool refraction = true;       // of the surroundings, through transmitting materials; else opaque
  bool bump = true;             // normal maps and height textures
  bool shadows = true;          // of the key light
  bool wireframe = false;       // surfaces as lines
  bool zones = false;           // a colour per zone
  bool tetrahedra = false;      // of soft bodies, as lines
  bool contacts = false;        // of soft and rigid bodies: normals, and an arrow along each force
  bool handles = false;         // of tools: their frame, and a line to their device

  bool operator==(const RenderOptions&) const = default;
};

class Renderer {
 public:
  // Uploads constant data, and the current heights, so call it while the touch clock does not run. Needs a current
  // OpenGL 4.5 context (gpu/context.h), here and in every later call. Call again after structural changes.
  static Result<std::unique_ptr<Renderer>> create(const World& world);
  ~Renderer();

  // Takes the newest zones, probes and poses; call for every acquired snapshot, before draw.
  void update(const Snapshot& snapshot);
  void update(const SoftSnapshot& snapshot);
  void take(World& world);  // all that its clocks have published since
  RenderOptions& options();
  // Draws into the framebuffer `target` of width x height pixels.
  FrameStats draw(const Viewpoint& viewpoint, std::uint32_t target, int width, int height);
  // Draws into an internal framebuffer and reads it back, rows top to bottom.
  Image picture(const Viewpoint& viewpoint, int width, int height, FrameStats* stats = nullptr);

  // Picks with the next picture, through its viewpoint; the last of several questions counts.
  void pick(const PickQuestion& question);
  // The answer, once. Waits for the GPU only if `wait` is set; then it is available right after the next picture.
  std::optional<PickAnswer> picked(bool wait = false);

 private:
  Renderer();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pliant
