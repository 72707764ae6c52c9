// Runs `pliant validate` on the current document in the background.
#pragma once

#include <vector>

#include "editor/core/editor.h"

namespace pliant {

class FindingsWatch {
 public:
  static constexpr double kRest = 0.5;  // [s] without a change before it starts
  void update(Editor& editor);          // once per frame
  bool up_to_date(const Editor& editor) const { return editor.found_at == editor.document.revision(); }

 private:
  std::uint64_t seen_ = ~std::uint64_t{0}, document_ = ~std::uint64_t{0};
  double since_ = 0.0;  // [s] of the last change
};

// Findings of a level made from this state: the node of each, and its quick fix.
std::vector<EditorFinding> editor_findings(const State& state, const Findings& findings);

// All findings of the state; referenced files are looked up in `folder`. Once `stop` is set it soon returns the
// findings so far.
Findings find_in_state(const State& state, const std::filesystem::path& file, const std::filesystem::path& folder,
                       const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
