// Draws the viewport's pictures on a separate thread, with a context that shares textures with the window, so that the
// interface stays responsive. The newest order is drawn; the newest finished picture is shown.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "components/appearance.h"
#include "editor/viewport/solid_view.h"
#include "viewer/picture/picture_budget.h"
#include "viewer/window/window.h"

namespace pliant {

// An alternative to the document in the viewport: a played level. Created, used and destroyed on the stage's thread
// with its context current.
class Scenery {
 public:
  virtual ~Scenery() = default;
  // Into a framebuffer of this size. After an error the document is shown instead, with the error.
  virtual Status draw(const SolidOrder& order, GLuint framebuffer, int width, int height) = 0;
  // Before a picture: the pixel for which pick() will be called.
  virtual void ask(std::optional<dvec2>) {}
  // In the last picture; pixels count from the upper left corner.
  virtual SolidPicked pick(double x, double y) = 0;
  virtual Status reload() { return Done{}; }           // its shaders; after an error the old ones are kept
  virtual bool moves() const { return true; }          // a new picture may be needed without a new order
  virtual bool wants_picture() const { return true; }  // a new picture is needed now
};

struct StageOrder {
  SolidOrder solid;
  int width = 1, height = 1;      // [pixel]
  std::optional<dvec2> question;  // [pixel] to be picked
  std::uint64_t question_number = 0;
};

struct StagePicture {
  GLuint texture = 0;         // of the window's context; valid until the next picture is taken. Rows bottom to top
  int width = 0, height = 0;  // [pixel] of the texture
  double share = 1.0;         // [1] of the ordered resolution
  double draw_ms = 0.0;
  std::size_t triangles = 0;
  std::uint64_t number = 0;  // count of pictures so far
  std::uint64_t order = 0;   // the order that it answers
  Viewpoint view;            // its view
  double orthographic = 0.0;
  std::uint64_t question = 0;  // the question answered by `picked`; 0: none yet
  SolidPicked picked;
  std::string trouble;  // why it differs from the order
};

class Stage {
 public:
  // On the window's thread. `wake` is called on the stage's thread when a picture is finished.
  static Result<std::unique_ptr<Stage>> create(Window& window, std::function<void()> wake);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // Replaces an order that has not started. Returns its number.
  std::uint64_t order(StageOrder order);
  // The newest finished picture; the previous one may be overwritten from now on.
  StagePicture picture();
  bool busy() const;  // an order is not answered yet, or not in full
  // On the stage's thread, before the next picture: `make` returns the scenery to show, or null for the document. The
  // previous scenery is destroyed first.
  void show(std::function<std::unique_ptr<Scenery>()> make);
  // Recompiles the shaders; errors are the trouble of the next pictures.
  void reload_shaders();
  // A picture of that size, independent of those that are shown; `then` is called on the stage's thread.
  void shoot(StageOrder order, std::function<void(Result<Image>)> then);
  // Runs on the stage's thread before the next picture, with its context current.
  void post(std::function<void()> task);

 private:
  Stage() = default;
  void run();
  void draw(const StageOrder& order, std::uint64_t number, bool refine);
  Result<Image> shot(const StageOrder& order);
  void answer(const StageOrder& order, std::uint64_t number);

  Window* window_ = nullptr;
  std::unique_ptr<SharedContext> context_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<StageOrder> next_;
  StageOrder last_;
  std::uint64_t ordered_ = 0, answered_ = 0;
  std::vector<std::function<void()>> tasks_;
  StagePicture done_;
  int showing_ = -1, finished_ = -1;  // the target shown by the window, and the last finished one
  bool stop_ = false;
  bool coarse_ = false;  // the newest picture is coarse, and will be redrawn in full when idle
  std::chrono::steady_clock::time_point drawn_at_{};  // the stage's thread's
  // For the stage's thread.
  struct Target {
    GLuint texture = 0, frame = 0;
    int width = 0, height = 0;
  };
  static void resize(Target& target, int width, int height);
  Target targets_[3];
  std::unique_ptr<SolidView> solid_;
  std::unique_ptr<Scenery> scenery_;
  std::optional<StageOrder> drawn_;  // of the document, shown by the newest picture
  PictureBudget budget_;
  std::string failure_, shader_trouble_;
  std::thread thread_;
};

}  // namespace pliant
