// The resolution of the next picture, so that a slow renderer (GPU, or CPU in its place) stays responsive: a late
// picture is worse than a coarse one.
#pragma once

namespace pliant {

class PictureBudget {
 public:
  static constexpr double kSlow = 60.0, kFast = 18.0, kWanted = 35.0;  // [ms]
  static constexpr double kCoarsest = 0.25;                            // [1]

  // `finest` [1] of the full resolution, each way; above 1 edges are smoothed.
  explicit PictureBudget(double finest = 1.0) : finest_(finest) {}
  double share() const { return share_; }  // [1] of the full resolution, each way
  void drawn(double took);                 // [ms] of a picture at share()
  // [1] The share of a picture that may take `time` [ms]: no coarser than share(), at most the full resolution.
  double share_within(double time) const;

 private:
  double finest_, share_ = 1.0;
  double took_ms_ = 0.0;                          // of the last picture
  double fixed_ms_ = 0.0;                         // of a picture, whatever its resolution
  double sample_pixels_ = 0.0, sample_ms_ = 0.0;  // [1] of all, [ms]: an earlier picture of another resolution
};

}  // namespace pliant
