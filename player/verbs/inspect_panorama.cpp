#include "player/verbs/inspect_panorama.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "content/files/exr.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Luminance of linear RGB with Rec. 709 primaries.
double luminance(const float* rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace

bool is_panorama_file(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".exr";
}

int inspect_panorama(const std::filesystem::path& path, bool as_json) {
  std::vector<std::string> notes;
  const auto panorama = load_panorama(path, &notes);
  if (!panorama) return fail(kFailed, panorama.error());
  const std::size_t pixels = panorama->rgb.size() / 3;
  double sum = 0.0, most = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double here = luminance(&panorama->rgb[3 * i]);
    sum += here;
    most = std::max(most, here);
  }
  if (panorama->width != 2 * panorama->height)
    notes.push_back("is not twice as wide as high; a latitude-longitude panorama is, so it will look stretched");
  OrderedJson json = {
      {"file", path.string()},      {"width", panorama->width},
      {"height", panorama->height}, {"mean_luminance", pixels ? sum / static_cast<double>(pixels) : 0.0},
      {"largest_luminance", most},  {"notes", notes}};
  if (as_json) {
    print_json(json);
    return kDone;
  }
  print("{}\n  panorama: {} x {} pixels, luminance {:.3g} on average, {:.3g} at most\n", path.string(), panorama->width,
        panorama->height, json["mean_luminance"].get<double>(), most);
  for (const std::string& sentence : notes) print("  note: {}\n", sentence);
  print("  surrounds a level: name it in PLIANT_environment/panorama; a preview: `pliant convert FILE sky.png`\n");
  return kDone;
}

}  // namespace pliant
