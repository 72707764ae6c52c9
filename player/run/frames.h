// Pictures of a run without a window: their ticks, and how they are taken.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/world.h"
#include "lab/files/output_folder.h"
#include "runtime/clock.h"
#include "runtime/histogram.h"
#include "runtime/result.h"
#include "systems/visual/renderer.h"

namespace pliant {

class HeadlessContext;

// Ticks of `count` pictures spread over a run of `ticks`: each in the middle of its share.
std::vector<std::uint64_t> spread_frames(std::uint64_t ticks, int count);
inline constexpr int kMostFrames = 10000;  // per run: file names have four digits
// Ticks of `fps` pictures per simulated second at `rate` ticks per second, at most kMostFrames.
std::vector<std::uint64_t> regular_frames(std::uint64_t ticks, double rate, double fps);

// Cost of drawing.
class FrameFigures {
 public:
  void add(const FrameStats& stats);
  std::size_t count() const { return static_cast<std::size_t>(cost_.count()); }
  const Histogram& cost() const { return cost_; }
  std::uint64_t upload_bytes() const { return upload_sum_; }
  std::uint64_t upload_bytes_max() const { return upload_max_; }

 private:
  Histogram cost_;
  std::uint64_t upload_sum_ = 0, upload_max_ = 0;  // [byte]
};

class Frames {
 public:
  // Creates a graphics context. The error names what is missing.
  static Result<std::unique_ptr<Frames>> create(const World& world, PictureQuality quality, int width, int height);
  ~Frames();

  // Lockstep, after a tick: takes all changes, in as many snapshots as needed.
  void update_all(World& world, Tick tick);
  // Real time, from the visual clock's thread: takes the newest snapshot, if there is one.
  void update(World& world);
  // Draws the state taken and stages it as the next frame-NNNN.png.
  Status take(OutputFolder& out);

  std::size_t count() const { return count_; }
  const FrameFigures& figures() const { return figures_; }

 private:
  Frames() = default;
  std::unique_ptr<HeadlessContext> context_;
  std::unique_ptr<Renderer> renderer_;  // destroyed before the context
  Viewpoint viewpoint_;
  int width_ = 0, height_ = 0;  // [pixel]
  std::size_t count_ = 0;
  FrameFigures figures_;
};

}  // namespace pliant
