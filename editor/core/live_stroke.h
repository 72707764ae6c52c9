// A stroke computed on a separate thread, so that large dabs do not block the interface. The result depends only on the
// input, not on timing.
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
  // `layers`: the current paint, one per primitive, empty if unpainted. `wake` is called on the stroke's thread when
  // there are results.
  LiveStroke(std::shared_ptr<const PaintSurface> surface, std::vector<PaintLayer> layers, PaintAttribute attribute,
             const Brush& brush, std::function<void()> wake);
  ~LiveStroke();  // discards pending dabs
  LiveStroke(const LiveStroke&) = delete;
  LiveStroke& operator=(const LiveStroke&) = delete;

  void move(const Ray& ray, double pressure);  // surface frame
  void finish();                               // end of input; pending dabs are still made
  bool finished() const;                       // all dabs are made and taken
  bool idle() const;                           // all input so far is processed and taken

  struct Made {
    std::vector<std::pair<std::uint32_t, PaintLayer>> layers;  // changed primitives in their current state
    std::optional<SurfaceHit> at;                              // the last dab
  };
  // Results since the last call.
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
