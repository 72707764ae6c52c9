#include "editor/app/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "content/files/image.h"
#include "editor/app/app.h"
#include "editor/app/native_dialog.h"
#include "runtime/printable.h"

extern char** environ;

namespace pliant {
namespace {

namespace fs = std::filesystem;

// Around the vertical through the target.
Viewpoint turned(Viewpoint view, double share) {
  const dmat4 turn = glm::rotate(dmat4(1.0), 2.0 * glm::pi<double>() * share, dvec3(0, 1, 0));
  view.eye = view.target + dvec3(turn * glm::dvec4(view.eye - view.target, 0.0));
  view.up = dvec3(turn * glm::dvec4(view.up, 0.0));
  return view;
}

// H.264 needs even sizes. True: the film is there.
bool encode(const fs::path& folder, double rate, const fs::path& film) {
  const std::string frames = (folder / "%05d.png").string(), per_second = fmt::format("{:g}", rate), to = film.string();
  std::vector<std::string> command{"ffmpeg",   "-y",      "-loglevel", "error", "-framerate",
                                   per_second, "-i",      frames,      "-vf",   "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                   "-pix_fmt", "yuv420p", to};
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int end : {0, 1, 2}) posix_spawn_file_actions_addopen(&actions, end, "/dev/null", O_RDWR, 0);
  pid_t process = 0;
  const int failed = ::posix_spawnp(&process, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return failed == 0 && ::waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::size_t FilmRequest::frames() const {
  return kind == Kind::kPicture ? 1 : static_cast<std::size_t>(std::max(1.0, std::round(seconds * rate)));
}

void Film::start(const FilmRequest& request) {
  if (on_) return;
  request_ = request;
  frame_ = 0;
  stepped_ = false;
  shot_.reset();
  if (request.kind != FilmRequest::Kind::kPicture) {
    std::error_code failed;
    fs::create_directories(request.to, failed);
    if (failed)
      return app_.editor.say(fmt::format("{} cannot be made ({})", printable(request.to.string()), failed.message()),
                             Severity::kError);
    if (!fs::is_empty(request.to, failed))
      return app_.editor.say(printable(request.to.string()) + " is not empty: choose another folder for the film",
                             Severity::kError);
  }
  if (request.kind == FilmRequest::Kind::kPlayed) app_.play_stepwise();
  on_ = true;
}

void Film::stop() {
  if (!on_) return;
  on_ = false;
  app_.editor.say(
      fmt::format("Film given up after {} frames, which stay in {}", frame_, printable(request_.to.string())));
}

std::string Film::progress() const {
  return fmt::format("{} of {}", frame_, request_.frames());
}

// A played level is stepped in exact ticks, however long a picture takes.
bool Film::ready() {
  if (request_.kind != FilmRequest::Kind::kPlayed) return true;
  Play& play = app_.play();
  if (!play.on()) {
    app_.editor.say("the level does not play any more, so the film ends", Severity::kWarning);
    finish();
    return false;
  }
  if (!play.ready() || !play.may_step()) return false;
  const PlayStatus& status = play.status();
  if (frame_ == 0) {
    tick_ = status.tick;
    return true;
  }
  const auto due =
      tick_ + static_cast<std::uint64_t>(std::llround(static_cast<double>(frame_) * status.rate / request_.rate));
  if (status.tick >= due) return true;
  if (!stepped_) play.step(due - status.tick);
  stepped_ = true;
  return false;
}

void Film::shoot() {
  Viewpoint view = request_.view;
  if (request_.kind == FilmRequest::Kind::kTurntable)
    view = turned(view, static_cast<double>(frame_) / static_cast<double>(request_.frames()));
  const fs::path file =
      request_.kind == FilmRequest::Kind::kPicture ? request_.to : request_.to / fmt::format("{:05}.png", frame_);
  shot_ = std::make_shared<Shot>();
  app_.stage().shoot(
      app_.plain_order(view, request_.width, request_.height), [shot = shot_, file](Result<Image> image) {
        shot->written = image ? write_file(file, encode_png(image->width, image->height, image->rgba.data()))
                              : Status(image.error());
        shot->done = true;
      });
}

void Film::update() {
  if (!on_) return;
  if (!shot_) {
    if (ready() && on_) shoot();
    return;
  }
  if (!shot_->done) return;
  if (!shot_->written) {
    on_ = false;
    return app_.editor.say(shot_->written.error().message(), Severity::kError);
  }
  shot_.reset();
  stepped_ = false;
  if (++frame_ == request_.frames()) finish();
}

void Film::finish() {
  on_ = false;
  Editor& editor = app_.editor;
  const std::string name = printable(request_.to.filename().string());
  if (request_.kind == FilmRequest::Kind::kPicture) return editor.say("Picture in " + name);
  editor.say(fmt::format("{} frames in {}", frame_, name));
  if (!program_there("ffmpeg"))
    return editor.say("ffmpeg is not installed: the film stays a folder of PNGs", Severity::kWarning);
  fs::path film = request_.to;
  film += ".mp4";
  editor.jobs.start("film", "Encoding " + name, [folder = request_.to, rate = request_.rate, film](const Jobs::Stop&) {
    const bool made = encode(folder, rate, film);
    return [made, film](Editor& to) {
      if (made) return to.say("Film in " + printable(film.filename().string()));
      to.say("ffmpeg could not write " + printable(film.string()) + "; the PNGs are there", Severity::kError);
    };
  });
}

}  // namespace pliant
