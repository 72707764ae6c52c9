// check_data: times and rotations of animations.
#include <cmath>
#include <vector>

#include "content/gltf/check/gltf_data.h"

namespace pliant {

namespace {

void check_times(DataCheck& check, std::size_t input) {
  if (!check.first(input, DataRole::kTimes)) return;
  float before = -1.0f;
  for (const float time : read_floats(check.document, input)) {
    if (time < 0.0f || time <= before)
      return check.error(pointer_of(input), "holds times that are negative or do not increase");
    before = time;
  }
}

void check_rotations(DataCheck& check, std::size_t output, bool cubic) {
  if (!check.first(output, cubic ? DataRole::kRotationSplines : DataRole::kRotations)) return;
  const std::vector<float> q = read_floats(check.document, output);
  for (std::size_t k = 0; k * 4 + 4 <= q.size(); ++k) {
    if (cubic && k % 3 != 1) continue;  // tangents are stored before and after each value
    const float norm = std::sqrt(q[4 * k] * q[4 * k] + q[4 * k + 1] * q[4 * k + 1] + q[4 * k + 2] * q[4 * k + 2] +
                                 q[4 * k + 3] * q[4 * k + 3]);
    if (std::abs(norm - 1.0f) > kUnitTolerance)
      return check.error(pointer_of(output), fmt::format("holds a rotation of length {:.3g} instead of 1", norm));
  }
}

}  // namespace

void check_animation_data(DataCheck& check) {
  for (const Json& animation : array_of(check.document.json, "animations")) {
    for (const Json& sampler : animation["samplers"]) check_times(check, sampler["input"].get<std::size_t>());
    for (const Json& channel : animation["channels"]) {
      if (channel["target"]["path"] != "rotation") continue;
      const Json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
      check_rotations(check, sampler["output"].get<std::size_t>(),
                      value_of<std::string>(sampler, "interpolation", "LINEAR") == "CUBICSPLINE");
    }
  }
}

}  // namespace pliant
