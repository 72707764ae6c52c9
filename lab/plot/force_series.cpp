#include "lab/plot/force_series.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <complex>
#include <limits>
#include <nlohmann/json.hpp>

#include "content/files/file_io.h"
#include "lab/files/csv.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLongest = 4096;  // rows of the longest window of a spectrum
constexpr std::size_t kShortest = 64;   // below it there is no spectrum
constexpr double kUneven = 0.01;        // [1] of the usual row interval
constexpr double kClosed = 1e-9;        // [1] of the positive work: rounding
constexpr double kFast = 20.0;          // [Hz]
constexpr double kPiOfWindow = 3.14159265358979323846;

double number_of(std::string_view cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

void transform(std::vector<std::complex<double>>& x) {  // radix 2, in place (Cooley & Tukey 1965)
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1)
    for (std::size_t i = 0; i < n; i += length)
      for (std::size_t k = 0; k < length / 2; ++k) {
        const double angle = -2 * kPiOfWindow * static_cast<double>(k) / static_cast<double>(length);
        const std::complex<double> a = x[i + k],
                                   b = x[i + k + length / 2] * std::complex<double>(std::cos(angle), std::sin(angle));
        x[i + k] = a + b;
        x[i + k + length / 2] = a - b;
      }
}

}  // namespace

std::map<std::string, bool> tools_of(const fs::path& report) {
  std::map<std::string, bool> out;
  const Result<Bytes> bytes = read_file(report, limits::kScriptFile);
  if (!bytes) return out;
  const auto json = nlohmann::json::parse(bytes->begin(), bytes->end(), nullptr, /*allow_exceptions*/ false);
  if (!json.is_object() || !json.contains("probes") || !json["probes"].is_array()) return out;
  for (const auto& probe : json["probes"])
    if (probe.is_object() && probe.contains("name") && probe["name"].is_string())
      out[probe["name"].get<std::string>()] = probe.contains("tool_force");
  return out;
}

Result<RunSeries> read_series(const fs::path& run) {
  std::error_code ignored;
  const bool folder = fs::is_directory(run, ignored);
  const fs::path file = folder ? run / "forces.csv" : run;
  if (folder && !fs::exists(file, ignored))
    return Error{run.string(), "has no forces.csv", "name the folder that a run wrote (its --out)"};
  const Result<Bytes> bytes = read_file(file, limits::kFile);
  if (!bytes) return bytes.error();
  std::string_view text{reinterpret_cast<const char*>(bytes->data()), bytes->size()};
  const auto take_line = [&] {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  };
  std::vector<std::string> header;
  csv_cells(take_line(), ',', header);
  const auto place = [&](const char* name) { return csv_column(header, name); };
  for (const char* name : {"time_s", "depth_m", "fn"})
    if (place(name) == kNoColumn)
      return Error{file.string(), std::string("has no column `") + name + "`", "name a forces.csv that a run wrote"};
  RunSeries out;
  out.run = run.string();
  for (const char* name : {"ft", "in_contact", "object", "probe"})
    if (place(name) == kNoColumn) out.notes.push_back(out.run + ": has no column `" + name + "`");
  const std::size_t time = place("time_s"), depth = place("depth_m"), normal = place("fn"), tangential = place("ft"),
                    contact = place("in_contact"), object = place("object"), probe = place("probe"),
                    torque = place("tx");
  std::map<std::string, bool> tools = tools_of(file.parent_path() / "report.json");
  const bool reported = !tools.empty();
  std::map<std::string, std::size_t> number;
  std::size_t row = 1;
  std::vector<std::string> cells;
  while (!text.empty()) {
    const std::string_view line = take_line();
    ++row;
    if (line.empty()) continue;
    csv_cells(line, ',', cells);
    if (cells.size() < header.size()) cells.resize(header.size());  // empty ones at the end
    const std::string name = probe < cells.size() ? cells[probe] : std::string("probe");
    const auto [found, fresh] = number.try_emplace(name, out.series.size());
    if (fresh) {
      ForceSeries& series = out.series.emplace_back();
      series.run = out.run;
      series.probe = name;
      series.tool = tools[name];
    }
    ForceSeries& series = out.series[found->second];
    const double t = number_of(cells[time]), d = number_of(cells[depth]), f = number_of(cells[normal]);
    if (!std::isfinite(t) || !std::isfinite(d) || !std::isfinite(f))
      return Error{file.string() + ":" + std::to_string(row), "has no number where time_s, depth_m and fn stand",
                   "correct the row or leave it out"};
    series.time.push_back(t);
    series.depth.push_back(d);
    series.normal.push_back(f);
    if (tangential < cells.size()) series.tangential.push_back(number_of(cells[tangential]));
    if (contact < cells.size() ? cells[contact] == "1" : f > 0) ++series.contact;
    if (object < cells.size() && !cells[object].empty() &&
        std::find(series.objects.begin(), series.objects.end(), cells[object]) == series.objects.end())
      series.objects.push_back(cells[object]);
    if (!reported && torque < cells.size() && number_of(cells[torque]) != 0.0 && !std::isnan(number_of(cells[torque])))
      series.tool = true;
  }
  if (out.series.empty()) return Error{file.string(), "has no rows", "name a run that had a probe or a tool"};
  return out;
}

SeriesSummary summary_of(const ForceSeries& s) {
  SeriesSummary out;
  const std::size_t n = s.time.size();
  if (n == 0) return out;
  const double tick = n > 1 ? (s.time.back() - s.time.front()) / static_cast<double>(n - 1) : 0.0;
  out.seconds = s.time.back() - s.time.front();
  out.contact = tick * static_cast<double>(s.contact);
  double square = 0.0, pressed = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    out.depth = std::max(out.depth, s.depth[i]);
    if (s.normal[i] > out.force) {
      out.force = s.normal[i];
      out.stiffness = s.depth[i] > 0 ? s.normal[i] / s.depth[i] : 0.0;
    }
    if (s.normal[i] > 0) square += s.normal[i] * s.normal[i], pressed += 1.0;
    if (i == 0) continue;
    const double work = 0.5 * (s.normal[i] + s.normal[i - 1]) * (s.depth[i] - s.depth[i - 1]);
    out.lost += work;
    if (work > 0) out.put_in += work;
  }
  out.rms = pressed > 0 ? std::sqrt(square / pressed) : 0.0;
  if (std::abs(out.lost) < kClosed * out.put_in) out.lost = 0.0;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const auto pressed_at = [&](std::size_t i) { return s.normal[i] > 0 && s.depth[i] > 0; };
  if (pressed_at(0) || pressed_at(n - 1)) out.lost = kUnknown;
  if (s.tool) out.stiffness = out.put_in = out.lost = kUnknown;
  const Spectrum spectrum = spectrum_of(s);
  double power = 0.0;
  for (std::size_t i = 0; i < spectrum.density.size(); ++i)
    if (spectrum.frequency[i] > kFast) power += spectrum.density[i] * spectrum.density[i] * spectrum.frequency[0];
  out.fast = std::sqrt(power);
  return out;
}

Spectrum spectrum_of(const ForceSeries& s) {
  Spectrum out;
  const std::size_t n = s.time.size();
  if (n < kShortest) return out;
  const double tick = (s.time.back() - s.time.front()) / static_cast<double>(n - 1);
  if (!(tick > 0)) return out;
  for (std::size_t i = 1; i < n; ++i)
    out.even = out.even && std::abs(s.time[i] - s.time[i - 1] - tick) < kUneven * tick;
  std::size_t window = kShortest;
  while (2 * window <= std::min(n, kLongest)) window *= 2;
  std::vector<double> hann(window), power(window / 2, 0.0);
  double energy = 0.0;
  for (std::size_t i = 0; i < window; ++i) {
    hann[i] = 0.5 - 0.5 * std::cos(2 * kPiOfWindow * static_cast<double>(i) / static_cast<double>(window));
    energy += hann[i] * hann[i];
  }
  // Windows are spread evenly from the first row to the last; each overlaps the previous one by half or more.
  const std::size_t left = n - window, windows = 1 + (left + window / 2 - 1) / (window / 2);
  std::vector<std::complex<double>> part(window);
  for (std::size_t k = 0; k < windows; ++k) {
    const std::size_t begin = windows > 1 ? k * left / (windows - 1) : 0;
    double mean = 0.0;
    for (std::size_t i = 0; i < window; ++i) mean += s.normal[begin + i];
    mean /= static_cast<double>(window);
    for (std::size_t i = 0; i < window; ++i) part[i] = hann[i] * (s.normal[begin + i] - mean);
    transform(part);
    for (std::size_t i = 0; i < window / 2; ++i) power[i] += std::norm(part[i]);
  }
  for (std::size_t i = 1; i < window / 2; ++i) {
    out.frequency.push_back(static_cast<double>(i) / (tick * static_cast<double>(window)));
    out.density.push_back(std::sqrt(2 * power[i] * tick / (energy * static_cast<double>(windows))));
  }
  return out;
}

}  // namespace pliant
