#include "editor/play/law_curve.h"

#include "systems/touch/model/contact_law.h"

namespace pliant {

LawCurve law_curve(const Deformable& surface, double radius, double rate, double deepest, std::size_t points) {
  LawCurve out;
  const Motion moves = motion(surface, 1.0 / rate);
  const ContactLaw law = contact_law(surface, moves, 1.0, radius);
  for (std::size_t i = 0; i <= points; ++i) {
    const double depth = deepest * static_cast<double>(i) / static_cast<double>(points);
    out.slow.emplace_back(depth, law.force(depth));
    if (law.arm > 0.0) out.fast.emplace_back(depth, (1 + law.arm) * law.force(depth));
  }
  return out;
}

}  // namespace pliant
