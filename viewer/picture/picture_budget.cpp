#include "viewer/picture/picture_budget.h"

#include <algorithm>
#include <cmath>

namespace pliant {

// Only the cost of the pixels can be reduced. That of the triangles is estimated from two pictures of different
// resolution.
void PictureBudget::drawn(double took) {
  const double pixels = share_ * share_;
  if (std::abs(pixels - sample_pixels_) > 0.05 && sample_pixels_ > 0.0)
    fixed_ms_ = std::clamp(took - pixels * (took - sample_ms_) / (pixels - sample_pixels_), 0.0, took);
  fixed_ms_ = std::min(fixed_ms_, took);
  took_ms_ = took;
  if (took <= kSlow && (took >= kFast || share_ >= finest_)) return;
  const double per_pixel = std::max(took - fixed_ms_, 0.1) / pixels,
               room = std::max(kWanted - fixed_ms_, 0.5 * fixed_ms_);
  sample_pixels_ = pixels;
  sample_ms_ = took;
  share_ = std::clamp(std::sqrt(room / per_pixel), std::max(kCoarsest, 0.5 * share_), std::min(finest_, 2.0 * share_));
  if (std::abs(share_ - 1.0) < 0.1) share_ = 1.0;
}

double PictureBudget::share_within(double time) const {
  const double finer = share_ * std::sqrt(time / std::max(took_ms_, 1.0));
  return std::max(share_, std::min(finer, 1.0));
}

}  // namespace pliant
