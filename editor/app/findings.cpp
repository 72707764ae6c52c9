#include "editor/app/findings.h"

#include <algorithm>
#include <charconv>

#include "content/keys/extension_table.h"
#include "content/validate.h"
#include "systems/soft/prepare_soft.h"
#include "systems/soft/under_gravity.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

// "/nodes/3/extensions/PLIANT_probe/device" -> the node from there; otherwise the name of a new node.
const DocumentNode* node_of(const State& state, const std::string& pointer) {
  constexpr std::string_view kNodes = "/nodes/";
  if (pointer.starts_with(kNodes)) {
    int number = -1;
    std::from_chars(pointer.data() + kNodes.size(), pointer.data() + pointer.size(), number);
    for (const auto& each : state.nodes)
      if (each->node.source == number && number >= 0) return each.get();
    return nullptr;
  }
  const DocumentNode* longest = nullptr;
  for (const auto& each : state.nodes) {
    const std::string& name = each->node.name;
    if (name.empty() || !pointer.starts_with(name)) continue;
    if (pointer.size() > name.size() && pointer[name.size()] != '/') continue;
    if (!longest || name.size() > longest->node.name.size()) longest = each.get();
  }
  return longest;
}

// "…/extensions/PLIANT_handle/box" -> handle, box
bool key_of(const std::string& pointer, std::string& extension, std::string& key) {
  constexpr std::string_view kMark = "/extensions/PLIANT_";
  const std::size_t at = pointer.find(kMark);
  if (at == std::string::npos) return false;
  const std::string rest = pointer.substr(at + kMark.size());
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos) return false;
  extension = rest.substr(0, slash);
  key = rest.substr(slash + 1);
  std::replace(key.begin(), key.end(), '/', '.');
  return true;
}

bool is_known(const std::string& extension, const std::string& key) {
  for (const Extension& each : extension_table())
    if (extension == each.name)
      return std::any_of(each.keys.begin(), each.keys.end(), [&](const auto& k) { return key == k.name; });
  return false;
}

QuickFix without(const char* label, NodeId id, const char* extension) {
  return {label,
          [id, extension](const State& s, NodeId&) { return without_component(s, std::span(&id, 1), extension); }};
}

QuickFix with(std::string label, NodeId id, std::string extension, std::string key, Json value) {
  return {std::move(label),
          [=](const State& s, NodeId&) { return with_value(s, std::span(&id, 1), extension, key, value); }};
}

// Gives a probe or tool its own device.
Result<State> with_device(const State& state, NodeId id) {
  const NodeIds one(&id, 1);
  Result<State> next(state);
  if (!has_component(state, id, "haptic_device")) next = with_component(state, one, "haptic_device");
  if (next) next = with_value(*next, one, "haptic_device", "driver", "mouse");
  const bool probe = state.find(id)->node.probe.has_value();
  if (next) next = with_value(*next, one, probe ? "probe" : "handle", "device", next->find(id)->node.name);
  return next;
}

// A device name that does not exist: replaced by the one probably meant, else by a new device.
std::optional<QuickFix> fix_of_device(const State& state, const DocumentNode& node) {
  const LevelNode& it = node.node;
  const std::string named = it.probe ? it.probe_device : it.handle ? it.handle->device : "";
  const DocumentNode* const device = state.find(named);
  if (named.empty() || (device && device->node.device)) return {};
  std::vector<std::string> devices;
  for (const auto& each : state.nodes)
    if (each->node.device) devices.push_back(each->node.name);
  if (const std::string meant = nearest(named, devices); !meant.empty())
    return with("Use the device " + meant, node.id, it.probe ? "probe" : "handle", "device", meant);
  return QuickFix{"Add a device, moved by the mouse",
                  [id = node.id](const State& s, NodeId&) { return with_device(s, id); }};
}

std::optional<QuickFix> fix_of(const State& state, const DocumentNode* node, const Finding& finding) {
  std::string extension, key;
  const bool has_key = key_of(finding.pointer, extension, key) && is_known(extension, key);
  if (!node) {
    // Scene keys: a missing panorama, a key without effect.
    if (has_key && extension == "environment" && key == "panorama" && finding.severity == Severity::kError)
      return QuickFix{"Without the panorama",
                      [](const State& s, NodeId&) { return with_default(s, {}, "environment", "panorama"); }};
    return {};
  }
  const LevelNode& it = node->node;
  const NodeId id = node->id;
  const auto is = [&](const char* code) { return finding.code == code; };
  if (is("level.rigid_and_deformable") && it.deformable)
    return without("Remove the deformable surface", id, "deformable");
  if (is("level.soft_and_rigid")) return without("Remove the rigid body", id, "rigid_body");
  if (is("level.handle_of_nothing")) return without("Remove the handle", id, "handle");
  if (is("level.handle_of_fixed")) return with("Let it move", id, "rigid_body", "fixed", false);
  if (is("tissue.leaves_behind")) return with("Take them along", id, "soft_body", "carries", "inside");
  if (is("tissue.gravity") && it.soft_body && it.soft_body->under_gravity != UnderGravity::kModelled)
    return with("Keep its shape under gravity", id, "soft_body", "under_gravity", "modelled");
  if (is("level.unmoved_probe"))
    return QuickFix{"Add a device, moved by the mouse", [id](const State& s, NodeId&) { return with_device(s, id); }};
  if (is("level.unknown_device"))
    if (std::optional<QuickFix> fix = fix_of_device(state, *node)) return fix;
  if (has_key && finding.severity == Severity::kNote && !value_of_key(state, id, extension, key).is_null())
    return QuickFix{"Reset " + key, [id, extension, key](const State& s, NodeId&) {
                      return with_default(s, std::span(&id, 1), extension, key);
                    }};
  if (has_key && extension == "haptic_device" && key == "file" && it.device)  // its driver requires it
    return QuickFix{"Without the script", [id](const State& s, NodeId&) {
                      Result<State> next = with_value(s, std::span(&id, 1), "haptic_device", "driver", "null");
                      return next ? with_default(*next, std::span(&id, 1), "haptic_device", "file") : next;
                    }};
  if (has_key && finding.severity == Severity::kError && value_of_key(state, id, extension, key).is_string())
    return QuickFix{"Clear " + key, [id, extension, key](const State& s, NodeId&) {
                      return with_default(s, std::span(&id, 1), extension, key);
                    }};
  return {};
}

}  // namespace

std::vector<EditorFinding> editor_findings(const State& state, const Findings& findings) {
  std::vector<EditorFinding> all;
  for (const Finding& finding : findings) {
    EditorFinding found;
    found.finding = finding;
    const DocumentNode* const node = node_of(state, finding.pointer);
    if (node) found.node = node->id;
    found.fix = fix_of(state, node, finding);
    all.push_back(std::move(found));
  }
  std::stable_sort(all.begin(), all.end(), [](const EditorFinding& a, const EditorFinding& b) {
    return a.finding.severity < b.finding.severity;
  });
  return all;
}

Findings find_in_state(const State& state, const std::filesystem::path& file, const std::filesystem::path& folder,
                       const std::atomic<bool>* stop) {
  Level level = level_of(state);
  level.path = file.empty() ? folder / "untitled" : file;
  leave_out_scripts(level, state.scripts, DriverKind::kMouse);  // moved by anything
  if (!level.has_pliant())
    return {{Severity::kNote,
             "",
             "nothing can be touched yet: select a mesh and add a deformable surface or a soft body in the inspector",
             {},
             "level.nothing_touchable"}};
  const auto prepare = [stop](World& world) -> Status {
    for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft}) {
      if (stop && *stop) break;
      if (const Status status = prepare_system(world); !status) return status;
    }
    if (!stop || !*stop) find_sag(world);
    return Done{};
  };
  return validate_level(std::move(level), prepare, stop);
}

void FindingsWatch::update(Editor& editor) {
  const std::uint64_t revision = editor.document.revision();
  if (revision != seen_ || document_ != editor.documents) {
    seen_ = revision;
    document_ = editor.documents;
    since_ = editor.now;
    editor.jobs.cancel("findings");  // its result is obsolete
  }
  // One job at a time: a cancelled one ends at the next mesh or system. Not while a run needs the CPU.
  if (up_to_date(editor) || editor.playing || editor.now - since_ < kRest || editor.jobs.any("findings")) return;
  if (editor.state().nodes.empty()) {
    editor.findings.clear();
    editor.found_at = revision;
    return;
  }
  editor.jobs.start("findings", "",
                    [state = editor.state(), revision, document = editor.documents, read = editor.files_read,
                     file = editor.document.file(),
                     folder = editor.document.folder()](const Jobs::Stop& stop) -> std::function<void(Editor&)> {
                      if (stop) return {};
                      auto found = std::make_shared<std::vector<EditorFinding>>(
                          editor_findings(state, find_in_state(state, file, folder, &stop)));
                      return [found, revision, document, read](Editor& to) {
                        if (to.documents != document || to.files_read != read) return;
                        to.findings = std::move(*found);
                        to.found_at = revision;
                      };
                    });
}

}  // namespace pliant
