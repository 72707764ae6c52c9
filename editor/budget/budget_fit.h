// What an error budget chooses for an object of the document: measured in the background on a copy, kept until the
// document is another one, and known to be out of date once the object is another one. No window is needed for it.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "editor/app/editor.h"
#include "editor/document/said_keys.h"
#include "engine/choice/model_choice.h"

namespace pliant {

// Everything that figures of an object depend on, its budget apart: candidates do not depend on it.
struct FitSubject {
  std::shared_ptr<const DocumentMesh> mesh;
  std::map<LayerKey, PaintLayer> paint;  // of the mesh
  dmat4 to_world{1};
  Json object, simulation;  // keys
  double sphere = 0.0;      // [m] radius of the least spherical probe that meets surfaces: what it is pressed by
  bool operator==(const FitSubject&) const = default;
};
FitSubject fit_subject(const State& state, NodeId id);

// The extension whose `error` is the object's budget: "deformable" or "soft_body"; "": the node is neither.
std::string budget_extension(const LevelNode& node);
double budget_of(const LevelNode& node);  // [1] 0: none

struct BudgetFit {
  FitSubject subject;
  std::optional<FitSubject> used;  // the same object with the keys that were chosen
  Result<std::vector<ModelChoice>> choices = Error{"", "not measured"};  // surface and force law, or body and tool
  std::vector<SaidKey> keys;  // what was chosen, as keys that the level does not say
  double seconds = 0.0;       // that it took
};

// Measures as opening the level would choose, on the calling thread; `file` and `folder` are the document's.
BudgetFit fit_budget(const State& state, NodeId id, double budget, const std::filesystem::path& file,
                     const std::filesystem::path& folder, const ChoiceWatch& watch = {});
// Of what was measured, what another budget chooses.
ModelChoice with_budget(ModelChoice choice, double budget);
// Whether that is another model of any kind.
bool chooses_another(const std::vector<ModelChoice>& choices, double budget);

class BudgetFits {
 public:
  static constexpr const char* kJob = "error budget";

  void measure(Editor& editor, NodeId id, double budget);  // in the background; one object at a time
  void cancel(Editor& editor);
  // Once a frame: nothing is measured of an object that is gone, nor kept of another document.
  void update(Editor& editor);
  const BudgetFit* of(NodeId id) const;
  bool stale(const State& state, NodeId id) const;   // the object is another one than was measured
  bool in_use(const State& state, NodeId id) const;  // the level says what was chosen
  // Writes what was chosen as keys of the level: one edit. False: what stands in the way was said.
  bool use(Editor& editor, NodeId id);

  struct Progress {
    NodeId node = kNoNode;
    int parts = 0;         // measurements done
    double seconds = 0.0;  // since it began
  };
  std::optional<Progress> progress(const Editor& editor) const;  // nullopt: nothing is being measured

 private:
  struct Running {
    NodeId node = kNoNode;
    double began = 0.0;  // [s]
    std::shared_ptr<std::atomic<int>> parts;
  };
  std::uint64_t document_ = 0;  // that `fits_` are of
  std::map<NodeId, BudgetFit> fits_;
  std::optional<Running> running_;
};

// What the level says of an object that its budget would choose otherwise.
std::vector<SaidKey> said_of(const State& state, NodeId id);

}  // namespace pliant
