#include "editor/panels/level_pictures.h"

#include <epoxy/gl.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "content/files/image.h"
#include "content/level_file.h"
#include "editor/core/editor.h"
#include "editor/core/settings.h"
#include "runtime/printable.h"

extern char** environ;

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr float kShape = 0.6f;  // height over width of the visible part

// The command draws it in a separate process, which isolates the editor from the level.
Status draw_picture(const fs::path& level, const fs::path& folder, const Jobs::Stop& stop) {
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  std::vector<std::string> words{
      self.string(), "run",     level.string(), "--headless", "--seconds", "0.3",           "--frames", "1",
      "--size",      "400x240", "--threads",    "1",          "--out",     folder.string(), "--force"};
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, self.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return Error{level.string(), "no picture could be drawn"};
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(process), 15);
  int status = 0;
  constexpr int kPatience = 600;  // [0.1 s]
  for (int tenths = 0; ::waitpid(process, &status, WNOHANG) == 0; ++tenths) {
    if (stop || tenths > kPatience) {
      ::kill(process, SIGKILL);
      ::waitpid(process, &status, 0);
      return Error{level.string(), "took too long to draw"};
    }
    ::usleep(100000);
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return Error{level.string(), "could not be drawn"};
  return Done{};
}

fs::path first_picture(const fs::path& folder) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, none))
    if (entry.path().extension() == ".png" || entry.path().extension() == ".jpg") return entry.path();
  return {};
}

// Returns the picture file of the level, drawn if needed; empty: none.
fs::path picture_file(const fs::path& level, const Jobs::Stop& stop) {
  std::error_code none;
  const fs::path shipped = level.parent_path() / "../../docs/images" / (level.stem().string() + ".jpg");
  if (fs::is_regular_file(shipped, none)) return shipped;
  const auto written = fs::last_write_time(level, none).time_since_epoch().count();
  const fs::path cached = state_folder() / "pictures" / fmt::format("{}-{}.png", level.stem().string(), written);
  if (fs::is_regular_file(cached, none)) return cached;
  const fs::path folder = state_folder() / "pictures" / fmt::format("{}.{}", level.stem().string(), ::getpid());
  fs::create_directories(folder.parent_path(), none);
  const Status drawn = draw_picture(level, folder, stop);
  const fs::path found = drawn ? first_picture(folder) : fs::path();
  if (!found.empty()) fs::rename(found, cached, none);
  fs::remove_all(folder, none);
  return fs::is_regular_file(cached, none) ? cached : fs::path();
}

unsigned upload(const Image& image) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<int>(image.width), static_cast<int>(image.height), 0, GL_RGBA,
               GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  return texture;
}

}  // namespace

void LevelPictures::update(Editor& editor, const std::vector<fs::path>& levels) {
  if (!read_texts_) {
    read_texts_ = true;
    editor.jobs.start("level texts", "", [this, levels](const Jobs::Stop&) {
      std::map<fs::path, std::string> texts;
      for (const fs::path& level : levels)
        if (const Result<std::string> about = read_about(level); about)
          texts[level] = printable(about->substr(0, about->find('\n')));
      return [this, texts](Editor&) {
        for (const auto& [level, text] : texts) pictures_[level].about = text;
      };
    });
  }
  // One at a time: each may have to be drawn first.
  if (next_ >= levels.size() || editor.jobs.running("level picture")) return;
  editor.jobs.start("level picture", "", [this, level = levels[next_]](const Jobs::Stop& stop) {
    auto image = std::make_shared<Image>();
    if (const fs::path file = picture_file(level, stop); !file.empty())
      if (Result<Image> read = load_image(file); read) *image = *std::move(read);
    return [this, image, level](Editor&) {
      ++next_;
      if (image->width == 0 || image->height == 0) return;
      LevelPicture& picture = pictures_[level];
      picture.texture = upload(*image);
      // The central part, cropped to the card's aspect ratio.
      const float shape = static_cast<float>(image->height) / static_cast<float>(image->width);
      if (shape > kShape) {
        picture.low.y = 0.5f - 0.5f * kShape / shape;
        picture.high.y = 0.5f + 0.5f * kShape / shape;
      } else {
        picture.low.x = 0.5f - 0.5f * shape / kShape;
        picture.high.x = 0.5f + 0.5f * shape / kShape;
      }
    };
  });
}

}  // namespace pliant
