// A body that contacts cannot move: no degrees of freedom, so there is nothing to spread, solve or correct.
#pragma once

#include "systems/tool/body.h"

namespace pliant {

class ImmovableBody : public Body {
 public:
  int size() const override { return 0; }
  const Vector& velocity() const override { return nothing_; }
  void spread(const SurfacePoint&, const dmat3&, double, Rows&, int) const override {}
  void gather(const SurfacePoint&, const dmat3&, double, const Rows&, Eigen::Ref<Rows>) const override {}
  void solve(Rows&) const override {}
  void correct(const Vector&) override {}

 private:
  Vector nothing_;
};

}  // namespace pliant
