#include "editor/play/scene_view.h"

namespace pliant {

SceneView::SceneView(std::shared_ptr<World> world) : kept_(std::move(world)), world_(kept_.get()) {
  make();
}

SceneView::SceneView(std::shared_ptr<PlayRun> run) : run_(std::move(run)) {
  run_->make_picture([this](World& world) {
    world_ = &world;
    make();
  });
}

bool SceneView::wants_picture() const {
  return run_ && world_ && (run_->moving() || world_->snapshots->unseen());
}

void SceneView::make() {
  if (!world_) return;
  try {
    auto renderer = Renderer::create(*world_);
    if (renderer)
      renderer_ = std::move(renderer).value();
    else
      trouble_ = renderer.error().message();
  } catch (const std::exception& error) {
    trouble_ = std::string("the picture cannot be made: ") + error.what();
  }
}

Status SceneView::reload() {
  if (run_ || !world_) return Done{};
  auto renderer = Renderer::create(*world_);
  if (!renderer) return renderer.error();
  renderer_ = std::move(renderer).value();
  return Done{};
}

Status SceneView::draw(const SolidOrder& order, GLuint framebuffer, int width, int height) {
  if (!renderer_) return Error{"Rendered", trouble_.empty() ? "there is nothing to draw" : trouble_};
  if (run_) renderer_->take(*world_);
  RenderOptions& options = renderer_->options();
  options.wireframe = order.settings.wireframe;
  options.zones = order.settings.zones;
  options.tetrahedra = order.settings.tetrahedra;
  options.forces = order.settings.forces;
  options.contacts = options.contact_frames = options.handles = order.settings.contacts;
  options.markers = run_ != nullptr;
  if (asked_) renderer_->pick({asked_->x, asked_->y, width, height, 1, run_ ? run_->hand.holds() : kNoEntity});
  renderer_->draw(order.view, framebuffer, width, height);
  shown_ = order.state;
  view_ = order.view;
  width_ = width;
  height_ = height;
  return Done{};
}

SolidPicked SceneView::pick(double x, double y) {
  SolidPicked out;
  if (!renderer_ || !asked_) return out;
  asked_.reset();
  const std::optional<PickAnswer> answer = renderer_->picked(true);
  if (!answer) return out;
  if (run_) run_->hand.see(answer->seen, ray_through(view_, x, y, width_, height_));
  if (!answer->seen) return out;
  out.point = answer->seen->point;
  if (const Name* name = world_->registry.find<Name>(answer->seen->object))
    if (const DocumentNode* node = shown_.find(name->value)) out.node = node->id;
  return out;
}

}  // namespace pliant
