#include "systems/soft/local/lattice_calibration.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pliant {
namespace {

struct CalibratedRow {
  double poisson;
  LatticeCompliance at[4];  // R / c = 1.5, 2, 2.5, 3
};
constexpr CalibratedRow kCalibrated[] = {
    {0.0, {{.915, .911}, {.952, .949}, {.972, .970}, {.983, .981}}},
    {0.3, {{.937, .907}, {.967, .945}, {.982, .968}, {.990, .979}}},
    {0.4, {{.929, .886}, {.961, .931}, {.980, .957}, {.988, .971}}},
    {0.45, {{.917, .853}, {.953, .905}, {.970, .937}, {.983, .956}}},
    {0.47, {{.886, .820}, {.931, .879}, {.957, .916}, {.972, .938}}},
    {0.48, {{.861, .787}, {.912, .852}, {.943, .894}, {.961, .920}}},
    {0.49, {{.816, .718}, {.877, .791}, {.907, .845}, {.938, .878}}},
    {0.495, {{.730, .640}, {.804, .721}, {.855, .779}, {.890, .820}}},
};
constexpr double kFirstRadius = 1.5, kRadiusStep = 0.5, kLastRadius = 3.0;

LatticeCompliance mix(LatticeCompliance a, LatticeCompliance b, double share) {
  return {a.normal + share * (b.normal - a.normal), a.tangential + share * (b.tangential - a.tangential)};
}

// Beyond the table what is missing falls with the square of R / c.
LatticeCompliance at_radius(const CalibratedRow& row, double radius) {
  if (radius > kLastRadius) return mix({}, row.at[3], std::pow(kLastRadius / radius, 2));
  const double place = std::max(0.0, radius - kFirstRadius) / kRadiusStep;
  const int i = std::min(static_cast<int>(place), 2);
  return mix(row.at[i], row.at[i + 1], place - i);
}

double abscissa(double poisson) {
  return -std::log(0.5 - poisson);
}

}  // namespace

LatticeCompliance lattice_compliance(double poisson, double radius_over_cell) {
  const CalibratedRow* above = std::find_if(std::begin(kCalibrated) + 1, std::end(kCalibrated) - 1,
                                            [&](const CalibratedRow& row) { return row.poisson >= poisson; });
  const CalibratedRow& below = *(above - 1);
  const double share =
      (abscissa(poisson) - abscissa(below.poisson)) / (abscissa(above->poisson) - abscissa(below.poisson));
  return mix(at_radius(below, radius_over_cell), at_radius(*above, radius_over_cell), share);
}

}  // namespace pliant
