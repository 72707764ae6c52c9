#include "viewer/ui/fonts.h"

#include <fmt/format.h>
#include <fontconfig/fontconfig.h>
#include <imgui_internal.h>

#include <array>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "viewer/ui/theme.h"

namespace pliant::ui {
namespace {

constexpr const char* kRegular[] = {"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                                    "/usr/share/fonts/truetype/inter/Inter-Regular.ttf",
                                    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
constexpr const char* kStrong[] = {"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                                   "/usr/share/fonts/truetype/inter/Inter-SemiBold.ttf",
                                   "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};
constexpr unsigned kMostLetters = 3000;   // in addition to the permanent ones: the atlas is limited
constexpr unsigned kLastLetter = 0xffff;  // the largest that Dear ImGui draws

std::array<ImFont*, 4> g_fonts{};
std::set<unsigned> g_letters;  // in addition to the permanent ones
std::set<unsigned> g_looked_for, g_undrawable;
std::set<std::string> g_said;
bool g_short = false;

// A font file in memory, shared by the sizes; never freed.
std::string* file_of(const std::string& path) {
  static std::map<std::string, std::unique_ptr<std::string>> files;
  auto& file = files[path];
  if (!file) {
    std::ifstream in(path, std::ios::binary);
    file = std::make_unique<std::string>(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return file.get();
}

struct FallbackFont {
  std::string path;
  int index = 0;
  FcCharSet* letters = nullptr;
};

// Outline fonts in fontconfig's order for plain text.
const std::vector<FallbackFont>& fallback_fonts() {
  static const std::vector<FallbackFont> all = [] {
    std::vector<FallbackFont> found;
    FcConfig* const config = FcInitLoadConfigAndFonts();
    FcPattern* const pattern = FcPatternBuild(nullptr, FC_FAMILY, FcTypeString, "sans-serif", FC_OUTLINE, FcTypeBool,
                                              FcTrue, static_cast<char*>(nullptr));
    if (!config || !pattern) return found;
    FcConfigSubstitute(config, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcResult result = FcResultMatch;
    FcFontSet* const sorted = FcFontSort(config, pattern, FcFalse, nullptr, &result);
    for (int i = 0; sorted && i < sorted->nfont; ++i) {
      FcChar8 *path = nullptr, *format = nullptr;
      FcBool color = FcFalse;
      FcCharSet* letters = nullptr;
      int index = 0;
      if (FcPatternGetString(sorted->fonts[i], FC_FILE, 0, &path) != FcResultMatch ||
          FcPatternGetCharSet(sorted->fonts[i], FC_CHARSET, 0, &letters) != FcResultMatch)
        continue;
      FcPatternGetInteger(sorted->fonts[i], FC_INDEX, 0, &index);
      FcPatternGetBool(sorted->fonts[i], FC_COLOR, 0, &color);
      FcPatternGetString(sorted->fonts[i], FC_FONTFORMAT, 0, &format);
      const std::string_view kind = format ? reinterpret_cast<const char*>(format) : "";
      if (color || (kind != "TrueType" && kind != "CFF")) continue;
      found.push_back({reinterpret_cast<const char*>(path), index & 0xffff, letters});
    }
    FcPatternDestroy(pattern);
    return found;  // their character sets are owned by `sorted`
  }();
  return all;
}

// Ranges of single letters in Dear ImGui's format; they live as long as the atlas.
const ImWchar* ranges_of(const std::set<unsigned>& letters, std::deque<std::vector<ImWchar>>& kept) {
  std::vector<ImWchar>& ranges = kept.emplace_back();
  for (const unsigned letter : letters) {
    ranges.push_back(static_cast<ImWchar>(letter));
    ranges.push_back(static_cast<ImWchar>(letter));
  }
  ranges.push_back(0);
  return ranges.data();
}

// A four-byte UTF-8 letter, which Dear ImGui does not support. 0: none here.
unsigned high_letter(const char* c, const char* end) {
  if (end - c < 4) return 0;
  const auto byte = [c](int i) -> unsigned { return static_cast<unsigned char>(c[i]); };
  if ((byte(0) & 0xf8u) != 0xf0u) return 0;
  unsigned letter = byte(0) & 7u;
  for (int i = 1; i < 4; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
    letter = letter << 6 | (byte(i) & 0x3fu);
  }
  return letter > kLastLetter && letter <= 0x10ffff ? letter : 0;
}

// The script of a letter, and the package with a font for it.
const char* package_for(unsigned letter) {
  if (letter >= 0x1f000 && letter < 0x20000) return "emoji are not drawn";
  if (letter > kLastLetter) return "letters above U+FFFF are not drawn";
  if (letter >= 0x2e80 && letter < 0xfe00) return "install fonts-droid-fallback or fonts-noto-cjk";
  return "install fonts-noto-core or fonts-dejavu-core";
}

}  // namespace

ImFont* font(Type type) {
  return g_fonts[static_cast<std::size_t>(type)];
}

const char* load_fonts(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  g_short = false;
  // Latin with accents, Greek, Cyrillic, punctuation, arrows, and the symbols on buttons.
  static const ImWchar kRanges[] = {0x20,   0x17f,  0x370,  0x3ff,  0x400,  0x45f,  0x2010, 0x2044,
                                    0x2070, 0x209c, 0x2190, 0x21ff, 0x2200, 0x22ff, 0x2300, 0x23ff,
                                    0x25a0, 0x25ff, 0x2600, 0x26ff, 0x2713, 0x2718, 0};
  static const ImWchar kSigns[] = {0x2190, 0x21ff, 0x2300, 0x23ff, 0x25a0, 0x25ff, 0x2600, 0x26ff, 0x2713, 0x2718, 0};
  static std::deque<std::vector<ImWchar>> kept;
  kept.clear();
  std::map<const FallbackFont*, std::set<unsigned>> by_font;
  for (const unsigned letter : g_letters) {
    if (letter > kLastLetter) continue;
    for (const FallbackFont& fallback : fallback_fonts())
      if (FcCharSetHasChar(fallback.letters, letter) && !file_of(fallback.path)->empty()) {
        by_font[&fallback].insert(letter);
        break;
      }
  }
  std::vector<std::pair<const FallbackFont*, const ImWchar*>> more;
  for (const auto& [fallback, letters] : by_font) more.emplace_back(fallback, ranges_of(letters, kept));
  bool missing = false;
  const auto add = [&](const char* const(&files)[3], float size) -> ImFont* {
    ImFont* font = nullptr;
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.PixelSnapH = true;
    const float pixels = std::round(size * scale);
    const auto from = [&](const std::string& path, int index, const ImWchar* ranges) -> ImFont* {
      std::error_code gone;
      if (!std::filesystem::exists(path, gone)) return nullptr;
      std::string* const file = file_of(path);
      config.FontNo = index;
      return file->empty() ? nullptr
                           : io.Fonts->AddFontFromMemoryTTF(file->data(), static_cast<int>(file->size()), pixels,
                                                            &config, ranges);
    };
    for (const char* file : files) {
      font = from(file, 0, kRanges);
      if (!font) continue;
      config.MergeMode = true;
      if (file != files[2]) from(files[2], 0, kSigns);  // signs that Inter lacks
      break;
    }
    if (!font) {
      missing = true;
      font = io.Fonts->AddFontDefault();
      config.MergeMode = true;
    }
    for (const auto& [fallback, ranges] : more) from(fallback->path, fallback->index, ranges);
    return font;
  };
  g_fonts = {add(kRegular, 12), add(kRegular, 14), add(kStrong, 14), add(kStrong, 20)};
  io.FontDefault = g_fonts[1];
  io.Fonts->Build();
  for (const unsigned letter : g_letters)
    if (letter > kLastLetter || !g_fonts[1]->FindGlyphNoFallback(static_cast<ImWchar>(letter)))
      g_undrawable.insert(letter);
  return missing ? "no font was found; install fonts-inter or fonts-dejavu-core" : nullptr;
}

void draws(unsigned letter) {
  if (letter < 0x80 || g_looked_for.contains(letter) || !g_fonts[1]) return;
  if (g_letters.size() >= kMostLetters) return;
  g_looked_for.insert(letter);
  if (letter <= kLastLetter && g_fonts[1]->FindGlyphNoFallback(static_cast<ImWchar>(letter))) return;
  g_letters.insert(letter);
  g_short = true;
}

void draws(std::string_view text) {
  const char *c = text.data(), *const end = c + text.size();
  while (c < end) {
    if (static_cast<unsigned char>(*c) < 0x80) {
      ++c;
      continue;
    }
    if (const unsigned high = high_letter(c, end); high != 0) {
      draws(high);
      c += 4;
      continue;
    }
    unsigned letter = 0;
    const int bytes = ImTextCharFromUtf8(&letter, c, end);
    if (bytes <= 0) return;
    c += bytes;
    if (letter != 0xfffd) draws(letter);
  }
}

bool fonts_lack_letters() {
  return g_short;
}

std::string take_undrawable() {
  std::string text;
  for (const unsigned letter : std::exchange(g_undrawable, {})) {
    g_letters.erase(letter);
    const std::string cure = package_for(letter);
    if (!g_said.insert(cure).second) continue;
    char utf8[5] = {};
    ImTextCharToUtf8(utf8, letter);
    text += fmt::format("{}letters such as U+{:04X} '{}' cannot be drawn: {}", text.empty() ? "" : "; ", letter, utf8,
                        cure);
  }
  return text;
}

}  // namespace pliant::ui
