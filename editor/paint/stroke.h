// One stroke of a brush, from press to release. Dabs are spaced a quarter of a radius apart on the surface along the
// pointer's rays, whatever the pointer's speed.
//
// A dab and its mirror image count as one: where they overlap, the stronger one acts.
#pragma once

#include <array>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "editor/paint/brush.h"
#include "editor/paint/paint.h"

namespace pliant {

class Stroke {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  // The surface must outlive the stroke. `before` is shared and never changed.
  Stroke(const PaintSurface& surface, MeshPaint before, const Brush& brush);

  // The pointer has moved straight to `ray` (surface frame); `pressure` [1] multiplies the strength. Makes the dabs on
  // the way until `most_ms` [ms] have passed, at least one; the others are deferred. The final result does not depend
  // on the limit. Returns the changes since the last call.
  PaintChanges move(const Ray& ray, double pressure = 1.0, double most_ms = kNoLimit);
  // Makes deferred dabs.
  PaintChanges go_on(double most_ms = kNoLimit);
  bool waits() const { return !waiting_.empty(); }

  // The paint after the dabs so far: `before` itself if nothing has changed.
  MeshPaint after() const;
  const MeshPaint& before() const { return before_; }
  std::uint32_t dabs() const { return dabs_; }
  // Place of the last dab; empty before the first.
  const std::optional<SurfaceHit>& last_dab() const { return last_dab_; }

 private:
  // A vertex reached by the stroke.
  struct Entry {
    std::uint32_t vertex, node;
    float begin, now;            // [1]
    double most = 0.0;           // [1] the largest weight of any dab
    double weight = 0.0;         // [1] of this dab
    std::uint32_t dab = 0;       // the last dab that reached it
    std::uint32_t reported = 0;  // the call that has reported it
    bool changed = false;
  };
  struct Pointer {
    Ray ray;
    double pressure = 1.0;
    SurfaceHit hit;
  };
  // Limits of the stroke, or of its mirror image.
  struct Allowed {
    std::uint32_t part = SurfaceHit::kNone, primitive = SurfaceHit::kNone;  // those of its first dab
  };

  Pointer between(const Pointer& a, const Pointer& b, double t) const;
  void follow(const Pointer& to);
  void dab(const Pointer& at);
  void reach(const SurfaceHit& hit, double strength, Allowed& allowed);
  SurfaceHit mirrored(const SurfaceHit& hit) const;
  float value(std::uint32_t vertex) const;
  float blended(const Entry& entry) const;
  float smoothed(const Entry& entry) const;

  const PaintSurface& surface_;
  const MeshPaint before_;
  const Brush brush_;
  std::optional<Pointer> last_;
  std::deque<Pointer> waiting_;  // deferred dabs
  double travelled_ = 0.0;       // [m] since the last dab
  std::optional<SurfaceHit> last_dab_;
  std::uint32_t dabs_ = 0, calls_ = 0;
  std::array<Allowed, 2> allowed_;   // of the stroke and of its mirror image
  std::vector<std::uint32_t> slot_;  // of each welded vertex in entries_
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> dabbed_, reported_;  // entries
  std::vector<float> next_;
  MarchWork work_;
};

}  // namespace pliant
