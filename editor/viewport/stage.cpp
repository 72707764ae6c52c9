#include "editor/viewport/stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/clock.h"
#include "viewer/picture/window_png.h"

namespace pliant {
namespace {

constexpr double kTooLong = 1000.0;                            // [ms] limit for a full-resolution picture, to stay
                                                               // responsive
constexpr auto kRefineAfter = std::chrono::milliseconds(160);  // without changes, after which a coarse picture is
                                                               // redrawn in full
constexpr double kFinestPicture = 2.0;                         // [1] of the resolution, each way: edges are smoothed

}  // namespace

Result<std::unique_ptr<Stage>> Stage::create(Window& window, std::function<void()> wake) {
  std::unique_ptr<Stage> stage(new Stage());
  auto context = window.share();
  if (!context) return context.error();
  stage->window_ = &window;
  stage->context_ = *std::move(context);
  stage->wake_ = std::move(wake);
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = renderer && (std::strstr(renderer, "llvmpipe") || std::strstr(renderer, "softpipe"));
  stage->budget_ = PictureBudget(software ? 1.0 : kFinestPicture);
  window.take_context();
  stage->thread_ = std::thread([s = stage.get()] { s->run(); });
  return stage;
}

Stage::~Stage() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::uint64_t Stage::order(StageOrder order) {
  const std::lock_guard lock(mutex_);
  // A question not asked yet is added to this order.
  if (next_ && next_->question && !order.question) {
    order.question = next_->question;
    order.question_number = next_->question_number;
  }
  next_ = std::move(order);
  changed_.notify_all();
  return ++ordered_;
}

StagePicture Stage::picture() {
  const std::lock_guard lock(mutex_);
  showing_ = finished_;
  return done_;
}

bool Stage::busy() const {
  const std::lock_guard lock(mutex_);
  return answered_ != ordered_ || !tasks_.empty() || coarse_;
}

void Stage::post(std::function<void()> task) {
  const std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  changed_.notify_all();
}

void Stage::show(std::function<std::unique_ptr<Scenery>()> make) {
  post([this, make = std::move(make)] {
    scenery_.reset();
    if (make) scenery_ = make();
  });
}

void Stage::shoot(StageOrder order, std::function<void(Result<Image>)> then) {
  post([this, order = std::move(order), then = std::move(then)] { then(shot(order)); });
}

Result<Image> Stage::shot(const StageOrder& order) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (order.width > most || order.height > most)
    return Error{"picture", "is larger than this display draws", "choose at most " + std::to_string(most) + " pixels"};
  drawn_.reset();  // what it answered is drawn over
  Target target;
  resize(target, order.width, order.height);
  Status drawn = Error{"picture", failure_.empty() ? "there is nothing to draw" : failure_};
  try {
    if (scenery_) scenery_->ask({});
    if (scenery_) drawn = scenery_->draw(order.solid, target.frame, order.width, order.height);
    if (!scenery_ && solid_) {
      solid_->draw(order.solid, target.frame, order.width, order.height);
      drawn = Done{};
    }
  } catch (const std::exception& error) {
    drawn = Error{"picture", error.what()};
  }
  Image image;
  if (drawn) {
    image.width = static_cast<std::uint32_t>(order.width);
    image.height = static_cast<std::uint32_t>(order.height);
    image.rgba = frame_pixels(target.frame, order.width, order.height);
  }
  glDeleteFramebuffers(1, &target.frame);
  glDeleteTextures(1, &target.texture);
  if (!drawn) return drawn.error();
  return image;
}

void Stage::reload_shaders() {
  post([this] {
    shader_trouble_.clear();
    drawn_.reset();
    for (const auto& reload :
         {std::function<Status()>([this] { return solid_ ? solid_->reload() : Status(Done{}); }),
          std::function<Status()>([this] { return scenery_ ? scenery_->reload() : Status(Done{}); })})
      if (const Status status = reload(); !status) shader_trouble_ = status.error().message();
  });
}

void Stage::run() {
  context_->take();
  try {
    Result<SolidView> solid = SolidView::make();
    if (solid)
      solid_ = std::make_unique<SolidView>(*std::move(solid));
    else
      failure_ = solid.error().message();
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
  for (;;) {
    std::vector<std::function<void()>> tasks;
    std::optional<StageOrder> order;
    std::uint64_t number = 0;
    bool refine = false;
    {
      std::unique_lock lock(mutex_);
      const auto ready = [this] { return stop_ || next_ || !tasks_.empty(); };
      if (scenery_ && scenery_->moves()) {
        changed_.wait_for(lock, std::chrono::milliseconds(8), ready);
        refine = coarse_ && !ready() && !scenery_->wants_picture() &&
                 std::chrono::steady_clock::now() - drawn_at_ > kRefineAfter;
      } else if (coarse_)
        refine = !changed_.wait_for(lock, kRefineAfter, ready);
      else
        changed_.wait(lock, ready);
      if (stop_) break;
      if (!refine && !next_ && tasks_.empty() && !(scenery_ && scenery_->wants_picture())) continue;
      tasks.swap(tasks_);
      if (next_) last_ = *next_;
      order = last_;
      next_.reset();
      number = ordered_;
    }
    if (Window::lost()) break;
    for (const auto& task : tasks) task();
    if (number > 0) draw(*order, number, refine);
    wake_();
  }
  scenery_.reset();
  solid_.reset();
  if (!Window::lost()) {
    for (const Target& target : targets_) {
      glDeleteFramebuffers(1, &target.frame);
      glDeleteTextures(1, &target.texture);
    }
    context_->give();
  }
}

// Answers the question for the current picture.
void Stage::answer(const StageOrder& order, std::uint64_t number) {
  StagePicture done;
  {
    const std::lock_guard lock(mutex_);
    done = done_;
  }
  done.order = number;
  if (order.question && order.question_number != 0) {
    const dvec2 pixel = *order.question * done.share;
    done.question = order.question_number;
    done.picked = solid_->pick(pixel.x, pixel.y, done.share);
  }
  const std::lock_guard lock(mutex_);
  done_ = std::move(done);
  answered_ = number;
  if (last_.question && last_.question_number == done_.question) last_.question.reset();
}

void Stage::resize(Target& target, int width, int height) {
  if (target.width == width && target.height == height) return;
  glDeleteFramebuffers(1, &target.frame);
  glDeleteTextures(1, &target.texture);
  glCreateTextures(GL_TEXTURE_2D, 1, &target.texture);
  glTextureStorage2D(target.texture, 1, GL_RGBA8, width, height);
  glTextureParameteri(target.texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(target.texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(target.texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glCreateFramebuffers(1, &target.frame);
  glNamedFramebufferTexture(target.frame, GL_COLOR_ATTACHMENT0, target.texture, 0);
  target.width = width;
  target.height = height;
}

void Stage::draw(const StageOrder& order, std::uint64_t number, bool refine) {
  const bool same = solid_ && !scenery_ && drawn_ && drawn_->width == order.width && drawn_->height == order.height &&
                    same_scene(drawn_->solid, order.solid);
  if (same && !refine && drawn_->solid.hovered == order.solid.hovered) {
    answer(order, number);
    return;
  }
  // If only outlines changed, the picture is cheap at its current resolution.
  const double share = refine ? 1.0 : same ? done_.share : budget_.share();
  int at = 0;
  {
    const std::lock_guard lock(mutex_);
    while (at == showing_ || at == finished_) ++at;
  }
  Target& target = targets_[at];
  const int width = std::max(1, static_cast<int>(std::lround(order.width * share))),
            height = std::max(1, static_cast<int>(std::lround(order.height * share)));
  resize(target, width, height);
  const std::uint64_t began = now_ns();
  StagePicture done;
  done.trouble = failure_.empty() ? shader_trouble_ : failure_;
  drawn_.reset();
  try {
    bool drawn = false;
    if (scenery_) {
      scenery_->ask(order.question && order.question_number != 0 ? std::optional(*order.question * share)
                                                                 : std::nullopt);
      const Status status = scenery_->draw(order.solid, target.frame, width, height);
      drawn = status.ok();
      if (!drawn) done.trouble = status.error().message();
    }
    if (!drawn && solid_) {
      solid_->draw(order.solid, target.frame, width, height);
      if (!scenery_) drawn_ = order;
    }
    if (order.question && order.question_number != 0) {
      const dvec2 pixel = *order.question * share;
      done.question = order.question_number;
      done.picked = drawn    ? scenery_->pick(pixel.x, pixel.y)
                    : solid_ ? solid_->pick(pixel.x, pixel.y, share)
                             : SolidPicked{};
    }
  } catch (const std::exception& error) {
    done.trouble = std::string("the picture failed: ") + error.what();
  }
  glFinish();  // the other context may show it from now on
  const double took = static_cast<double>(now_ns() - began) * 1e-6;
  done.texture = target.texture;
  done.width = width;
  done.height = height;
  done.share = share;
  done.draw_ms = same && !refine ? done_.draw_ms : took;
  done.triangles = solid_ ? solid_->triangles() : 0;
  done.order = number;
  done.view = order.solid.view;
  done.orthographic = order.solid.orthographic;
  {
    const std::lock_guard lock(mutex_);
    done.number = done_.number + 1;
    if (done.question == 0) {
      done.question = done_.question;
      done.picked = done_.picked;
    }
    done_ = std::move(done);
    finished_ = at;
    answered_ = number;
    coarse_ = share < 1.0 && took < kTooLong;
    drawn_at_ = std::chrono::steady_clock::now();
    if (last_.question && last_.question_number == done_.question) last_.question.reset();
  }
  if (!same && !refine) budget_.drawn(took);
}

}  // namespace pliant
