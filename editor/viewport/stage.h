// The viewport's pictures, on a thread of their own with a context that shares textures with the window: however long
// one takes, the interface goes on answering. The newest order counts; the newest finished picture is shown.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "editor/viewport/solid_view.h"
#include "window/window.h"

namespace pliant {

// Something else than the document that the viewport may show: a level that is played. Made, called and destroyed on
// the stage's thread, its context current.
class Scenery {
 public:
  virtual ~Scenery() = default;
  // Into a framebuffer of this size. An error is shown, and the document instead.
  virtual Status draw(const SolidOrder& order, GLuint framebuffer, int width, int height) = 0;
  // Before a picture: pick() will be called for this pixel of it.
  virtual void ask(std::optional<dvec2>) {}
  // Pixels count from the upper left corner, of the picture drawn last.
  virtual SolidPicked pick(double x, double y) = 0;
  virtual Status reload() { return Done{}; }           // its shaders; an error leaves those that it has
  virtual bool moves() const { return true; }          // another picture may be wanted without a new order
  virtual bool wants_picture() const { return true; }  // and is, now
};

struct StageOrder {
  SolidOrder solid;
  int width = 1, height = 1;      // [pixel]
  std::optional<dvec2> question;  // [pixel] what stands there?
  std::uint64_t question_number = 0;
};

struct StagePicture {
  GLuint texture = 0;         // of the window's context; valid until the next picture is taken. Rows bottom to top
  int width = 0, height = 0;  // [pixel] of the texture
  double share = 1.0;         // [1] of the resolution that was ordered
  double draw_ms = 0.0;
  std::size_t triangles = 0;
  std::uint64_t number = 0;  // of pictures so far
  std::uint64_t order = 0;   // that it answers
  Viewpoint view;            // that it was drawn from
  double orthographic = 0.0;
  std::uint64_t question = 0;  // that `picked` answers; 0: none yet
  SolidPicked picked;
  std::string trouble;  // why it is not what was wanted
};

class Stage {
 public:
  // On the window's thread. `wake` is called on the stage's thread when a picture is done.
  static Result<std::unique_ptr<Stage>> create(Window& window, std::function<void()> wake);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // Replaces an order that has not begun. Returns its number.
  std::uint64_t order(StageOrder order);
  // The newest finished picture; the one before may be drawn over from now on.
  StagePicture picture();
  bool busy() const;  // an order has not been answered yet, or not in full
  // On the stage's thread, before the next picture: `make` returns what is shown instead of the document, or null for
  // the document again. What was shown before is destroyed first.
  void show(std::function<std::unique_ptr<Scenery>()> make);
  // Shaders are read and compiled again; what is wrong with them is the trouble of the next pictures.
  void reload_shaders();
  // Runs on the stage's thread before the next picture, its context current.
  void post(std::function<void()> task);

 private:
  Stage() = default;
  void run();
  void draw(const StageOrder& order, std::uint64_t number, bool refine);
  void answer(const StageOrder& order, std::uint64_t number);
  void choose_share(double took_ms);

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
  int showing_ = -1, finished_ = -1;  // which target the window shows, and which was finished last
  bool stop_ = false;
  bool coarse_ = false;  // the newest picture is, and will be drawn in full when nothing else is wanted
  std::chrono::steady_clock::time_point drawn_at_{};  // the stage's thread's
  // The stage's thread's own.
  struct Target {
    GLuint texture = 0, frame = 0;
    int width = 0, height = 0;
  };
  Target targets_[3];
  std::unique_ptr<SolidView> solid_;
  std::unique_ptr<Scenery> scenery_;
  std::optional<StageOrder> drawn_;               // of the document, that the newest picture shows
  double share_ = 1.0;                            // [1] of the resolution, of the next picture
  double fixed_ms_ = 0.0;                         // of a picture, whatever its resolution
  double sample_pixels_ = 0.0, sample_ms_ = 0.0;  // [1] of all, [ms]: an earlier picture of another resolution
  bool software_ = false;
  std::string failure_, shader_trouble_;
  std::thread thread_;
};

}  // namespace pliant
