// A body that contacts cannot move: without degrees of freedom there is nothing to push, solve or correct.
#pragma once

#include "systems/soft/body/body.h"

namespace pliant {

class ImmovableBody : public Body {
 public:
  int size() const override { return 0; }
  const Vector& velocity() const override { return nothing_; }
  void push(const SurfacePoint&, dvec3, Rows&, Eigen::Index) const override {}
  void gather(const SurfacePoint&, const dmat3&, double, const Rows&, Eigen::Ref<Rows>) const override {}
  void solve(Rows&) const override {}
  void correct(const Vector&) override {}

 private:
  Vector nothing_;
};

}  // namespace pliant
