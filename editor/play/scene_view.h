// A prepared World rendered as in play: materials, environment, shadows, probes and their forces, by the engine's
// renderer. Created, used and destroyed on the stage's thread.
#pragma once

#include <memory>
#include <optional>

#include "editor/play/play_run.h"
#include "editor/viewport/stage.h"
#include "systems/visual/renderer.h"

namespace pliant {

class SceneView : public Scenery {
 public:
  explicit SceneView(std::shared_ptr<World> world);  // which does not run
  explicit SceneView(std::shared_ptr<PlayRun> run);

  Status draw(const SolidOrder& order, GLuint framebuffer, int width, int height) override;
  void ask(std::optional<dvec2> pixel) override { asked_ = pixel; }
  SolidPicked pick(double x, double y) override;
  Status reload() override;  // for a played level: at the next Play
  bool moves() const override { return run_ != nullptr; }
  bool wants_picture() const override;

 private:
  void make();
  std::shared_ptr<World> kept_;
  std::shared_ptr<PlayRun> run_;
  World* world_ = nullptr;
  std::unique_ptr<Renderer> renderer_;
  std::string trouble_;
  std::optional<dvec2> asked_;
  // Of the picture drawn last.
  State shown_;
  Viewpoint view_;
  int width_ = 1, height_ = 1;
};

}  // namespace pliant
