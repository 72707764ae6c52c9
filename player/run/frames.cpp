#include "player/run/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/files/file_io.h"
#include "content/files/image.h"
#include "systems/touch/feed/publish.h"
#include "systems/visual/gpu/context.h"

namespace pliant {

std::vector<std::uint64_t> spread_frames(std::uint64_t ticks, int count) {
  std::vector<std::uint64_t> at;
  for (int i = 0; i < count && ticks > 0; ++i)
    at.push_back(static_cast<std::uint64_t>((i + 0.5) * static_cast<double>(ticks) / count));
  return at;
}

std::vector<std::uint64_t> regular_frames(std::uint64_t ticks, double rate, double fps) {
  std::vector<std::uint64_t> at;
  for (int i = 0; i < kMostFrames; ++i) {
    const auto tick = static_cast<std::uint64_t>(std::llround(i * rate / fps));
    if (tick >= ticks) break;
    at.push_back(tick);
  }
  return at;
}

void FrameFigures::add(const FrameStats& stats) {
  cost_.add(static_cast<std::uint64_t>(stats.draw_ms * 1e6));
  upload_sum_ += stats.upload_bytes;
  upload_max_ = std::max(upload_max_, stats.upload_bytes);
}

Frames::~Frames() = default;

Result<std::unique_ptr<Frames>> Frames::create(const World& world, PictureQuality quality, int width, int height) {
  std::unique_ptr<Frames> frames(new Frames);
  auto context = HeadlessContext::create();
  if (!context) return context.error();
  frames->context_ = std::move(context).value();
  auto renderer = Renderer::create(world);
  if (!renderer) return renderer.error();
  frames->renderer_ = std::move(renderer).value();
  frames->renderer_->options().quality = quality;
  frames->viewpoint_ = default_viewpoint(world);
  frames->width_ = width;
  frames->height_ = height;
  return frames;
}

void Frames::update(World& world) {
  renderer_->take(world);
}

void Frames::update_all(World& world, Tick tick) {
  // Each iteration takes as many zones as fit and the next takes the rest, so the loop ends.
  do {
    publish(world, tick);
    update(world);
  } while (waits_to_be_published(world));
}

Status Frames::take(OutputFolder& out) {
  FrameStats stats;
  const Image image = renderer_->picture(viewpoint_, width_, height_, &stats);
  figures_.add(stats);
  const Status written = write_file(out.stage(fmt::format("frame-{:04d}.png", count_)),
                                    encode_png(image.width, image.height, image.rgba.data()));
  if (written) ++count_;
  return written;
}

}  // namespace pliant
