// Parameters of a world that runs without a Session, as a window's sliders change them between ticks.
#pragma once

#include <map>
#include <string>

#include "components/world.h"
#include "engine/run/pose_recorder.h"
#include "engine/run/runner.h"
#include "engine/session/live_edit.h"
#include "engine/session/live_set.h"
#include "runtime/exchange.h"

namespace pliant {

class LiveWorld {
 public:
  // Keeps the values of a prepared world. Before the clocks start; the world must outlive it.
  explicit LiveWorld(World& world);
  // Changes apply before a tick. To be attached to the runner. `recorder`: notes them; null: not recording.
  TickPart tick_part(PoseRecorder* recorder);

  // As last set, by the names of Slider.
  Result<double> get(const std::string& object, const std::string& key) const;
  Status set(const std::string& object, const std::string& key, double value);

 private:
  World& world_;
  PoseRecorder* recorder_ = nullptr;
  std::map<std::string, LiveNamed> named_;
  Ring<Edit> edits_;
};

}  // namespace pliant
