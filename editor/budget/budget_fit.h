// Model parameters that an error budget chooses for an object. Measured in the background on a copy; kept for the
// document; marked stale when the object changes. Needs no window.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "editor/core/editor.h"
#include "editor/document/stated_keys.h"
#include "engine/choice/model_choice.h"

namespace pliant {

// Everything that the measurement depends on, except the budget: candidates do not depend on it.
struct FitSubject {
  std::shared_ptr<const DocumentMesh> mesh;
  std::map<LayerKey, PaintLayer> paint;  // of the mesh
  dmat4 to_world{1};
  Json object, simulation;  // keys
  double sphere = 0.0;      // [m] smallest radius of a spherical probe that touches surfaces
  bool operator==(const FitSubject&) const = default;
};
FitSubject fit_subject(const State& state, NodeId id);

// The extension whose `error` is the object's budget: "deformable" or "soft_body"; "": neither.
std::string budget_extension(const LevelNode& node);
double budget_of(const LevelNode& node);  // [1] 0: none

struct BudgetFit {
  FitSubject subject;
  std::optional<FitSubject> used;                                        // the same object with the chosen keys
  Result<std::vector<ModelChoice>> choices = Error{"", "not measured"};  // surface, or body and tool
  std::vector<StatedKey> keys;                                           // chosen keys that the level does not state
  double seconds = 0.0;                                                  // duration of the measurement
};

// Measures on the calling thread, with the choices that opening the level would make; `file` and `folder` are the
// document's.
BudgetFit fit_budget(const State& state, NodeId id, double budget, const std::filesystem::path& file,
                     const std::filesystem::path& folder, const ChoiceWatch& watch = {});
// The choice for another budget, from the same measurement.
ModelChoice with_budget(ModelChoice choice, double budget);
// Whether that differs in any model.
bool chooses_another(const std::vector<ModelChoice>& choices, double budget);

class BudgetFits {
 public:
  static constexpr const char* kJob = "error budget";

  void measure(Editor& editor, NodeId id, double budget);  // in the background; one object at a time
  void cancel(Editor& editor);
  // Call once per frame: cancels measurements of deleted objects, and drops results of other documents.
  void update(Editor& editor);
  const BudgetFit* of(NodeId id) const;
  bool stale(const State& state, NodeId id) const;   // the object has changed since the measurement
  bool in_use(const State& state, NodeId id) const;  // the level states the chosen keys
  // Writes the chosen keys to the level, as one edit. False: an error was reported.
  bool use(Editor& editor, NodeId id);

  struct Progress {
    NodeId node = kNoNode;
    int parts = 0;         // measurements done
    double seconds = 0.0;  // since the start
  };
  std::optional<Progress> progress(const Editor& editor) const;  // nullopt: no measurement is running

 private:
  struct Running {
    NodeId node = kNoNode;
    double began = 0.0;  // [s]
    std::shared_ptr<std::atomic<int>> parts;
  };
  std::uint64_t document_ = 0;  // the document of `fits_`
  std::map<NodeId, BudgetFit> fits_;
  std::optional<Running> running_;
};

// Keys stated in the level that the object's budget would otherwise choose.
std::vector<StatedKey> stated_keys(const State& state, NodeId id);

}  // namespace pliant
