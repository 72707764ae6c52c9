#include "plot/pen.h"

#include <algorithm>
#include <array>

namespace pliant {

void Pen::as_pixels(double, double, double, double, const std::function<void(Pen&)>& draw) {
  draw(*this);
}

void Pen::line(double x0, double y0, double x1, double y1, double width, bool dashed) {
  polyline(std::array{PlotPoint{x0, y0}, PlotPoint{x1, y1}}, width, dashed);
}

std::vector<std::string> Pen::lines(double size, const std::string& words, double widest) {
  std::vector<std::string> lines{""};
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    const std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
    if (lines.back().empty() || width(size, longer) <= widest)
      lines.back() = longer;
    else
      lines.push_back(word);
    begin = end + 1;
  }
  return lines;
}

}  // namespace pliant
