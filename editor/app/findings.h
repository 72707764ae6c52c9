// What `pliant validate` says, of the document as it stands: asked in the background while one works.
#pragma once

#include <vector>

#include "editor/app/editor.h"

namespace pliant {

class FindingsWatch {
 public:
  static constexpr double kRest = 0.5;  // [s] without a change before it is asked
  void update(Editor& editor);          // once a frame
  bool up_to_date(const Editor& editor) const { return editor.found_at == editor.document.revision(); }

 private:
  std::uint64_t seen_ = ~std::uint64_t{0}, document_ = ~std::uint64_t{0};
  double since_ = 0.0;  // [s] when the document became what it is
};

// Findings of a level that was made of this state: which node each is about, and what can be done about it.
std::vector<EditorFinding> editor_findings(const State& state, const Findings& findings);

// Everything that is found in the state; `folder` is where files that it names are sought.
// Once `stop` is set it soon returns what it has found so far.
Findings find_in_state(const State& state, const std::filesystem::path& file, const std::filesystem::path& folder,
                       const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
