#include "editor/play/run_findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "components/haptic_device.h"
#include "editor/core/path_editing.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

constexpr double kLongGate = 0.1;  // [s] of force withheld: shorter is normal at the start

// [s] End of a probe's or tool's path; 0: none.
double path_end(const State& state, const std::string& effector) {
  const DocumentNode* const node = state.find(effector);
  const DocumentNode* const device = node ? state.find(device_of(state, node->id)) : nullptr;
  if (!device || !device->node.device || device->node.device->driver != DriverKind::kScript) return 0.0;
  const auto script = state.scripts.find(device->node.device->file);
  if (script == state.scripts.end() || script->second->keys.empty()) return 0.0;
  return script->second->keys.back().time;
}

}  // namespace

std::vector<RunFinding> run_findings(const State& state, const PlayStatus& status,
                                     const std::vector<PlayTrace>& traces) {
  std::vector<RunFinding> all;
  constexpr unsigned kGate = 1u << static_cast<unsigned>(SafetyLimit::kGated);
  for (const PlayTrace& trace : traces) {
    if (trace.name.empty()) continue;
    RunFinding found{trace.name, {}, {}};
    const double gated = static_cast<double>(trace.gated) / status.rate;
    if (gated > kLongGate) {
      if (!trace.samples.empty() && (trace.samples.back().limited & kGate) != 0)
        found.brief = "no force: withheld until it has been outside once";
      found.text = fmt::format(
          "felt no force for {:.1f} s of the last run: it was withheld, as the run, or contact with its device, began "
          "inside what it touches; begin its path outside",
          gated);
    }
    const double end = path_end(state, trace.name);
    if (trace.touched == 0 && end > 0.0 && status.time >= end) {
      found.brief = "has touched nothing on its path";
      found.text = fmt::format(
          "touched nothing in the last run, {:.1f} s; set its keys on a surface that can be touched, or press deeper",
          status.time);
    }
    if (!found.brief.empty() || !found.text.empty()) all.push_back(std::move(found));
  }
  return all;
}

}  // namespace pliant
