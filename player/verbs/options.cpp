#include "player/verbs/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "content/files/limits.h"
#include "content/level/unit.h"
#include "pliant/content.h"

namespace pliant {

CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= low && value <= high) return {};
        return "must be between " + CLI::detail::to_string(low) + " and " + CLI::detail::to_string(high) + "; got '" +
               text + "'";
      },
      "");
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

CLI::Validator one_of(std::vector<std::string> words) {
  return CLI::Validator(
      [words](std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return {};
        return "must be one of " + joined(words) + "; got '" + text + "'";
      },
      "");
}

CLI::Validator named() {
  return CLI::Validator([](std::string& text) { return std::string(text.empty() ? "its name is empty" : ""); }, "");
}

std::string parse_size(const std::string& text, RunOptions& run) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &run.width, &run.height, &used) != 2 ||
      static_cast<std::size_t>(used) != text.size() || run.width < 16 || run.height < 16 || run.width > 8192 ||
      run.height > 8192)
    return "--size: must be WxH with both between 16 and 8192, such as 960x540; got '" + text + "'";
  run.sized = true;
  return {};
}

void add_unit(CLI::App* verb, std::optional<double>& unit, const char* what) {
  verb->add_option_function<std::string>(
          "--unit",
          [&unit](const std::string& text) {
            const auto metres = parse_unit(text);
            if (!metres) throw CLI::ValidationError(metres.error().where + " " + metres.error().sentence());
            unit = *metres;
          },
          what)
      ->type_name("m|cm|mm|in|METRES");
}

void add_limits(CLI::App* verb) {
  verb->add_option_function<double>("--limits", set_limit_factor,
                                    "factor on the limits on files (docs/cli.md), 1e-6 to 1000 (1)")
      ->check(within(kLimitFactor.min, kLimitFactor.max))
      ->type_name("N");
}

}  // namespace pliant
