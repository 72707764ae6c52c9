#include "systems/tool/handle_model.h"

#include <cmath>

#include "systems/soft/linear/symmetric_product.h"

namespace pliant {

void CondensedContacts::resize(int most_contacts, int most_modes) {
  const Eigen::Index rows = 3 * most_contacts;
  for (Vector* v : {&frequency2, &damping, &rate, &load, &inverse}) v->setZero(most_modes);
  for (Rows6* m : {&modal_mass, &modal_damping, &modal_stiffness, &border}) m->setZero(most_modes, 6);
  for (Rows6* m : {&from_handle, &reduced_handle}) m->setZero(rows, 6);
  from_modes.setZero(rows, most_modes);
  for (Rows6& m : from_handle_by_slip) m.setZero(rows, 6);
  for (Rows& m : from_modes_by_slip) m.setZero(rows, most_modes);
  flexibility.setZero(rows, rows);
  delassus.setZero(rows, rows);
  force.setZero(rows);
  gap.setZero(most_contacts);
  drift.setZero(rows);
  push.setZero(most_contacts);
  mu_static.assign(static_cast<std::size_t>(most_contacts), 0.0);
  mu_sliding.assign(static_cast<std::size_t>(most_contacts), 0.0);
  lean.assign(static_cast<std::size_t>(most_contacts), dvec2(0.0));
  turning.assign(static_cast<std::size_t>(most_contacts), dmat2(0.0));
  key.assign(static_cast<std::size_t>(most_contacts), 0);
  farthest.assign(static_cast<std::size_t>(most_contacts), 0.0);
  reach.assign(static_cast<std::size_t>(most_contacts), 0.0);
  slip.assign(static_cast<std::size_t>(most_contacts), dvec2(0.0));
  sliding.assign(static_cast<std::size_t>(most_contacts), 0);
  held.assign(static_cast<std::size_t>(most_contacts), 0);
  most.assign(static_cast<std::size_t>(most_contacts), HUGE_VAL);
  unbounded.assign(static_cast<std::size_t>(most_contacts), 0.0);
  stiff.assign(static_cast<std::size_t>(most_contacts), 0);
}

// methods.md 2.4, with the tissue's matrix being diagonal: A_tt = 1 + tick damping + tick^2 frequency2, A_th = border,
// A_hh = tissue_mass + tick tissue_damping + tick^2 tissue_stiffness.
void CondensedContacts::prepare_tick(double seconds) {
  tick = seconds;
  const double tick2 = tick * tick;
  const Eigen::Index rows = 3 * count;
  inverse.head(modes) = (1.0 + tick * damping.head(modes).array() + tick2 * frequency2.head(modes).array()).inverse();
  border.topRows(modes) =
      modal_mass.topRows(modes) + tick * modal_damping.topRows(modes) + tick2 * modal_stiffness.topRows(modes);
  reduced = tissue_mass + tick * tissue_damping + tick2 * tissue_stiffness;
  reduced_handle.topRows(rows) = from_handle.topRows(rows);
  auto w = delassus.topLeftCorner(rows, rows);
  w = flexibility.topLeftCorner(rows, rows) / (tick * (tick + flexibility_lag));
  if (modes == 0) return;
  const Rows6 followed = inverse.head(modes).asDiagonal() * border.topRows(modes);
  reduced -= border.topRows(modes).transpose() * followed;
  reduced_handle.topRows(rows).noalias() -= from_modes.topLeftCorner(rows, modes) * followed;
  const Rows scaled = inverse.head(modes).cwiseSqrt().asDiagonal() * from_modes.topLeftCorner(rows, modes).transpose();
  w += symmetric_product(scaled, scaled);
}

}  // namespace pliant
