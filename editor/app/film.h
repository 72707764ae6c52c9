// Pictures of the viewport at any size, and films: a turntable, or what is played. A film is a folder of numbered PNGs,
// and an MP4 beside them where ffmpeg is installed.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "runtime/result.h"
#include "systems/visual/renderer.h"

namespace pliant {

class App;

struct FilmRequest {
  enum class Kind : std::uint8_t { kPicture, kTurntable, kPlayed } kind = Kind::kPicture;
  std::filesystem::path to;  // file of a picture, folder of a film
  Viewpoint view;
  int width = 1280, height = 720;     // [pixel]
  double seconds = 4.0, rate = 30.0;  // [s], [1/s]
  std::size_t frames() const;
};

class Film {
 public:
  explicit Film(App& app) : app_(app) {}
  void start(const FilmRequest& request);
  void stop();
  void update();  // once per frame
  bool under_way() const { return on_; }
  std::string progress() const;  // "12 of 120"

 private:
  struct Shot {
    std::atomic<bool> done{false};
    Status written = Done{};
  };
  bool ready();  // the next frame can be drawn
  void shoot();
  void finish();

  App& app_;
  FilmRequest request_;
  bool on_ = false;
  std::size_t frame_ = 0;       // the next one
  std::uint64_t tick_ = 0;      // of the first frame of what is played
  bool stepped_ = false;        // towards the next frame
  std::shared_ptr<Shot> shot_;  // that is being drawn and written
};

}  // namespace pliant
