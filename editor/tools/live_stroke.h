// A stroke that is made on a thread of its own: no dab, however large, keeps the interface waiting. What is painted in
// the end depends on what the hand did, not on how fast either of both was.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "editor/paint/stroke.h"

namespace pliant {

class LiveStroke {
 public:
  // `layers`: what is painted, one for each primitive, empty where nothing is. `wake` is called on the stroke's thread
  // when there is something to take.
  LiveStroke(std::shared_ptr<const PaintSurface> surface, std::vector<PaintLayer> layers, PaintAttribute attribute,
             const Brush& brush, std::function<void()> wake);
  ~LiveStroke();  // what is not made yet never is
  LiveStroke(const LiveStroke&) = delete;
  LiveStroke& operator=(const LiveStroke&) = delete;

  void move(const Ray& ray, double pressure);  // surface frame
  void finish();                               // the hand has let go; what waits is still made
  bool finished() const;                       // ... and it is: nothing new comes any more
  bool idle() const;                           // all that the hand did so far is made, and taken

  struct Made {
    std::vector<std::pair<std::uint32_t, PaintLayer>> layers;  // of primitives that have changed, as they are now
    std::optional<SurfaceHit> at;                              // the last dab
  };
  // What has been made since the last call.
  Made take();

 private:
  void run(std::vector<PaintLayer> layers, PaintAttribute attribute, Brush brush);

  std::shared_ptr<const PaintSurface> surface_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  struct Pointer {
    Ray ray;
    double pressure;
  };
  std::deque<Pointer> pointers_;
  Made made_;
  bool working_ = false, finish_ = false, stop_ = false, finished_ = false;
  std::thread thread_;
};

}  // namespace pliant
