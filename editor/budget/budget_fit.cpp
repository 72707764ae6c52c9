#include "editor/budget/budget_fit.h"

#include <algorithm>

#include "content/keys/extension_table.h"
#include "engine/choice/surface_truth.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

// The chosen keys with their values.
std::vector<StatedKey> keys_set(const std::vector<ModelChoice>& choices, const Level& after, std::size_t node) {
  std::vector<StatedKey> keys;
  for (const ModelChoice& choice : choices)
    for (const ChoosableKey& each : choice.keys) {
      const Extension& of = *find_extension(each.extension);
      const void* const owner = of.on_scene ? static_cast<const void*>(&after) : &after.nodes[node];
      keys.push_back({each.extension, each.key, find_key(of, each.key)->get(owner)});
    }
  return keys;
}

void set_budget(LevelNode& node, double budget) {
  if (node.soft_body)
    node.soft_body->error = budget;
  else if (node.deformable)
    node.deformable->error = budget;
}

}  // namespace

std::string budget_extension(const LevelNode& node) {
  if (node.mesh < 0) return "";
  return node.soft_body ? "soft_body" : node.deformable ? "deformable" : "";
}

double budget_of(const LevelNode& node) {
  return node.soft_body ? node.soft_body->error : node.deformable ? node.deformable->error : 0.0;
}

FitSubject fit_subject(const State& state, NodeId id) {
  FitSubject subject;
  const DocumentNode* const node = state.find(id);
  if (!node) return subject;
  if (node->node.mesh >= 0) {
    const auto number = static_cast<std::uint32_t>(node->node.mesh);
    subject.mesh = state.meshes[number];
    for (const auto& [key, layer] : state.paint)
      if (key.mesh == number) subject.paint.emplace(LayerKey{0, key.primitive, key.channel}, layer);
  }
  subject.to_world = state.to_world(id);
  const Json extensions = node_extensions(node->node, Json());
  for (const char* name : {"PLIANT_deformable", "PLIANT_soft_body", "PLIANT_handle"})
    if (extensions.contains(name)) {
      subject.object[name] = extensions[name];
      subject.object[name].erase("error");
    }
  Level scene;
  scene.simulation = state.simulation;
  scene.stated = state.stated;
  subject.simulation = scene_extensions(scene, Json());
  subject.sphere = least_sphere(outline_of(state));
  return subject;
}

BudgetFit fit_budget(const State& state, NodeId id, double budget, const std::filesystem::path& file,
                     const std::filesystem::path& folder, const ChoiceWatch& watch) {
  const std::uint64_t begin = now_ns();
  BudgetFit fit;
  fit.subject = fit_subject(state, id);
  const std::size_t at = state.place(id);
  if (at >= state.nodes.size()) return fit;
  Level level = level_of(state);
  level.path = file.empty() ? folder / "untitled" : file;
  set_budget(level.nodes[at], budget);
  if (const Status size = check_level_size(level); !size) {
    fit.choices = size.error();
  } else {
    fit.choices = choose_model(level, at, watch);
    if (fit.choices) fit.keys = keys_set(*fit.choices, level, at);
  }
  fit.seconds = static_cast<double>(now_ns() - begin) * 1e-9;
  return fit;
}

ModelChoice with_budget(ModelChoice choice, double budget) {
  choice.budget = budget;
  choice.chosen = cheapest_within(choice.tried, budget);
  choice.within = choice.tried[choice.chosen].error <= budget;
  return choice;
}

bool chooses_another(const std::vector<ModelChoice>& choices, double budget) {
  return std::any_of(choices.begin(), choices.end(),
                     [&](const ModelChoice& choice) { return with_budget(choice, budget).chosen != choice.chosen; });
}

std::vector<StatedKey> stated_keys(const State& state, NodeId id) {
  const std::size_t at = state.place(id);
  if (at >= state.nodes.size()) return {};
  std::vector<StatedKey> said;
  for (const ChoosableKey& each : choosable_keys(outline_of(state), at))
    if (each.said) said.push_back({each.extension, each.key, value_of_key(state, id, each.extension, each.key)});
  return said;
}

void BudgetFits::measure(Editor& editor, NodeId id, double budget) {
  update(editor);
  const auto parts = std::make_shared<std::atomic<int>>(0);
  running_ = {id, editor.now, parts};
  editor.jobs.start(
      kJob, "",
      [this, state = editor.state(), id, budget, parts, document = editor.documents, file = editor.document.file(),
       folder = editor.document.folder(),
       wake = editor.jobs.wake](const Jobs::Stop& stop) -> std::function<void(Editor&)> {
        const ChoiceWatch watch = [&](const std::string&) {
          ++*parts;
          if (wake) wake();
          return !stop;
        };
        auto fit = std::make_shared<BudgetFit>();
        try {
          *fit = fit_budget(state, id, budget, file, folder, watch);
        } catch (const std::exception& error) {
          fit->choices = Error{state.find(id)->node.name, std::string("was not measured: ") + error.what()};
        }
        return [this, fit, id, document](Editor& to) {
          running_.reset();
          if (to.documents == document && to.state().find(id)) fits_[id] = std::move(*fit);
        };
      });
}

void BudgetFits::cancel(Editor& editor) {
  editor.jobs.cancel(kJob);
  running_.reset();
}

void BudgetFits::update(Editor& editor) {
  if (document_ != editor.documents) {
    document_ = editor.documents;
    fits_.clear();
    if (running_) cancel(editor);
  }
  if (!running_) return;
  const DocumentNode* const node = editor.state().find(running_->node);
  if (!node || budget_extension(node->node).empty()) cancel(editor);
}

const BudgetFit* BudgetFits::of(NodeId id) const {
  const auto it = fits_.find(id);
  return it == fits_.end() ? nullptr : &it->second;
}

bool BudgetFits::stale(const State& state, NodeId id) const {
  const BudgetFit* const fit = of(id);
  if (!fit) return false;
  const FitSubject now = fit_subject(state, id);
  return !(now == fit->subject || (fit->used && now == *fit->used));
}

bool BudgetFits::in_use(const State& state, NodeId id) const {
  const BudgetFit* const fit = of(id);
  return fit && fit->used && fit_subject(state, id) == *fit->used;
}

bool BudgetFits::use(Editor& editor, NodeId id) {
  const auto it = fits_.find(id);
  if (it == fits_.end() || !it->second.choices || stale(editor.state(), id)) return false;
  std::string models;
  for (const ModelChoice& choice : *it->second.choices)
    models += (models.empty() ? "" : "; ") + choice.tried[choice.chosen].label;
  if (!editor.apply("Use the model " + models, with_stated(editor.state(), id, it->second.keys))) return false;
  it->second.used = fit_subject(editor.state(), id);
  return true;
}

std::optional<BudgetFits::Progress> BudgetFits::progress(const Editor& editor) const {
  if (!running_) return {};
  return Progress{running_->node, running_->parts->load(), editor.now - running_->began};
}

}  // namespace pliant
