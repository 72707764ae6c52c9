#include "systems/soft/local/local_compliance.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

double both(double a, double b) {  // sigma of the loads of two contacts
  return kSigmaOfRadius * std::sqrt(0.5 * (a * a + b * b));
}
double smeared_sigma(const LocalPlace& i, const LocalPlace& j) {
  return both(i.smeared / i.lattice.normal, j.smeared / j.lattice.normal);
}

// [1/m] What the layer's base takes away at distance s. The calibration scales the whole of a contact's own smeared
// compliance, and leaves the field beyond the load alone.
double layer_part(const LocalPlace& i, const LocalPlace& j, double s, const LayerKernel& layer) {
  const double thickness = 0.5 * (i.thickness + j.thickness), sigma = smeared_sigma(i, j);
  const double k = 0.5 * (i.lattice.normal + j.lattice.normal);
  const double scaled =
      k * layer.below(0.0, both(i.smeared, j.smeared), thickness) - layer.below(0.0, sigma, thickness);
  return layer.below(s, both(i.own, j.own), thickness) - layer.below(s, sigma, thickness) -
         scaled * std::exp(-s * s / (4 * sigma * sigma));
}

Block dyad(dvec3 a, dvec3 b) {
  Block out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(r, c) = a[r] * b[c];
  return out;
}

}  // namespace

double local_normal_compliance(const LocalPlace& at, const LocalElasticity& tissue, const LayerKernel* layer) {
  const bool thin = layer && at.thickness > 0.0;
  const double factor = thin ? layer->punch(at.own / at.thickness) : 1.0;
  const double share = thin ? layer->share(at.smeared, at.thickness) : 1.0;
  return (1 / (at.own * factor) - at.lattice.normal * share / at.smeared) / (2 * tissue.reduced());
}

double local_tangential_compliance(const LocalPlace& at, const LocalElasticity& tissue) {
  return (2 - tissue.poisson) / (8 * tissue.shear()) * (1 / at.own - at.lattice.tangential / at.smeared);
}

Block local_self_compliance(const LocalPlace& at, const LocalElasticity& tissue, const LayerKernel* layer) {
  const double normal = local_normal_compliance(at, tissue, layer), along = local_tangential_compliance(at, tissue);
  return along * Block::Identity() + (normal - along) * dyad(at.normal, at.normal);
}

Block local_compliance(const LocalPlace& i, const LocalPlace& j, const LocalElasticity& tissue,
                       const LayerKernel* layer) {
  const dvec3 apart = i.at - j.at;
  const double s = length(apart), facing = dot(i.normal, j.normal);
  if (s > kPairReach * std::max(i.smeared, j.smeared)) return Block::Zero();
  const double own = both(i.own, j.own), sigma = smeared_sigma(i, j);
  const double sigma_t = both(i.smeared / i.lattice.tangential, j.smeared / j.lattice.tangential);
  const double sigma_m = std::sqrt(0.5 * (sigma * sigma + sigma_t * sigma_t)), nu = tissue.poisson;
  double normal = h0(s, own) - h0(s, sigma);
  if (layer && i.thickness > 0.0 && j.thickness > 0.0) normal -= layer_part(i, j, s, *layer);
  const double along = (1 - nu / 2) * (h0(s, own) - h0(s, sigma_t)), across = nu / 2 * (h2(s, own) - h2(s, sigma_t));
  const double mixed = (1 - 2 * nu) / (4 * M_PI * tissue.shear()) * (h1(s, own) - h1(s, sigma_m));

  // Each side in its own normal and tangents; r from j to i, along either surface.
  const auto along_surface = [&](dvec3 normal_there) {
    const dvec3 r = apart - dot(apart, normal_there) * normal_there;
    const double size = length(r);
    return size > 1e-12 * i.smeared ? r / size : dvec3(0.0);
  };
  const dvec3 at_i = along_surface(i.normal), at_j = along_surface(j.normal);
  const Block flat_i = Block::Identity() - dyad(i.normal, i.normal),
              flat_j = Block::Identity() - dyad(j.normal, j.normal);
  Block out = facing * normal / (M_PI * tissue.reduced()) * dyad(i.normal, j.normal);
  out += (flat_i * ((along - across) * Block::Identity() + 2 * across * dyad(at_i, at_j)) * flat_j) /
         (2 * M_PI * tissue.shear());
  out += facing * mixed * (dyad(at_i, j.normal) - dyad(i.normal, at_j));
  return out;
}

}  // namespace pliant
