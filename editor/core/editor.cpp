#include "editor/core/editor.h"

#include <algorithm>
#include <unordered_set>

#include "devices/choose.h"
#include "editor/core/painting.h"
#include "editor/document/resting_mesh.h"
#include "editor/viewport/frames.h"

namespace pliant {

Editor::Editor() : painting(std::make_unique<Painting>(*this)) {}
Editor::~Editor() = default;

bool Editor::apply(const std::string& what, Result<State> next, const std::string& gesture) {
  const State before = state();
  const std::uint64_t revision = document.revision();
  if (const Status status = document.change(what, std::move(next), gesture); !status) {
    say(status.error().message(), Severity::kError);
    return false;
  }
  if (document.revision() != revision)
    for (const auto& each : on_change) each(before, state());
  forget_gone();
  return true;
}

void Editor::take(Document next) {
  const State before = state();
  document = std::move(next);
  ++documents;
  selected.clear();
  hovered = kNoNode;
  surfaces_.clear();
  resting_.clear();
  findings.clear();
  found_at = ~std::uint64_t{0};
  camera = CameraControl::before(scene_box());
  for (const auto& each : on_change) each(before, state());
  for (const std::string& note : document.notes()) say(note);
}

void Editor::revert_to(Level level, const FileStamp& stamp, const std::string& what) {
  const State before = state();
  std::vector<std::string> names;
  for (const NodeId id : selected)
    if (const DocumentNode* node = before.find(id)) names.push_back(node->node.name);
  document.revert_to(std::move(level), stamp, what);
  selected.clear();
  for (const std::string& name : names)
    if (const DocumentNode* node = state().find(name)) selected.push_back(node->id);
  for (const auto& each : on_change) each(before, state());
  forget_gone();
  for (const std::string& note : document.notes()) say(note);
}

void Editor::go_to_step(std::size_t step) {
  if (step >= document.step_count() || step == document.step()) return;
  const State before = state();
  document.go_to_step(step);
  for (const auto& each : on_change) each(before, state());
  forget_gone();
}

void Editor::undo() {
  if (!document.can_undo()) return;
  const State before = state();
  const std::string what = document.undo_what();
  document.undo();
  for (const auto& each : on_change) each(before, state());
  forget_gone();
  say("Undone: " + what);
}

void Editor::drop_gesture(const std::string& gesture) {
  const State before = state();
  if (!document.drop_gesture(gesture)) return;
  for (const auto& each : on_change) each(before, state());
  forget_gone();
}

void Editor::redo() {
  if (!document.can_redo()) return;
  const State before = state();
  const std::string what = document.redo_what();
  document.redo();
  for (const auto& each : on_change) each(before, state());
  forget_gone();
  say("Done again: " + what);
}

bool Editor::is_selected(NodeId id) const {
  return std::find(selected.begin(), selected.end(), id) != selected.end();
}

void Editor::select(NodeId id, bool add) {
  if (!add) selected.clear();
  if (id == kNoNode) return;
  const auto it = std::find(selected.begin(), selected.end(), id);
  if (it != selected.end())
    selected.erase(it);
  else
    selected.push_back(id);
}

void Editor::forget_gone() {
  std::unordered_set<NodeId> there;
  for (const auto& each : state().nodes) there.insert(each->id);
  const auto gone = [&](NodeId id) { return !there.contains(id); };
  std::erase_if(selected, gone);
  if (gone(hovered)) hovered = kNoNode;
  std::erase_if(view.isolated, gone);
}

void Editor::say(const std::string& text, Severity severity) {
  if (!said.empty() && said.back().text == text && said.back().severity == severity) {
    ++said.back().times;
    said.back().time = now;
    return;
  }
  said.push_back({now, severity, text});
  if (said.size() > kMostSaid) said.pop_front();
}

Box Editor::scene_box() const {
  return bounds_of(state());
}

void Editor::frame_selected() {
  Box box = bounds_of(state(), selected);
  if (!box.empty() && !(box.diagonal() > 0.0f)) {  // a box of zero size: enlarge it so that its surroundings are
                                                   // visible
    const float whole = scene_box().diagonal(), half = whole > 0.0f ? 0.1f * whole : 0.05f;
    box.min -= half;
    box.max += half;
  }
  camera.frame(box);
}

std::shared_ptr<const PaintSurface> Editor::surface_of(NodeId id) {
  const DocumentNode* const node = state().find(id);
  if (!node || node->node.mesh < 0) return nullptr;
  const auto mesh = state().meshes[static_cast<std::size_t>(node->node.mesh)];
  const dmat3 frame(state().to_world(id));
  const std::string job = "surface " + std::to_string(id);
  for (const auto& each : surfaces_)
    if (each->mesh == mesh && each->frame == frame) {
      if (each->surface || each->failed || jobs.running(each->job)) return each->surface;
      surfaces_.erase(std::find(surfaces_.begin(), surfaces_.end(), each));  // its job was replaced by another one
      break;
    }
  if (surfaces_.size() > 32) surfaces_.erase(surfaces_.begin());
  auto made = std::make_shared<Surface>();
  made->mesh = mesh;
  made->frame = frame;
  made->job = job;
  surfaces_.push_back(made);
  jobs.start(job, "Preparing " + node->node.name, [made](const Jobs::Stop& stop) {
    auto surface = PaintSurface::make(*made->mesh, made->frame, &stop);
    std::shared_ptr<const PaintSurface> ready;
    std::string fault;
    if (surface)
      ready = std::make_shared<const PaintSurface>(*std::move(surface));
    else
      fault = surface.error().message();
    return [made, ready, fault](Editor& editor) {
      made->surface = ready;
      made->failed = !ready;
      if (!fault.empty()) editor.say(fault, Severity::kWarning);
    };
  });
  return nullptr;
}

std::shared_ptr<const PaintSurface> Editor::surface_now(NodeId id) {
  if (auto ready = surface_of(id)) return ready;
  const DocumentNode* const node = state().find(id);
  if (!node || node->node.mesh < 0) return nullptr;
  const auto mesh = state().meshes[static_cast<std::size_t>(node->node.mesh)];
  const dmat3 frame(state().to_world(id));
  auto made = PaintSurface::make(*mesh, frame);
  if (!made) return nullptr;
  auto ready = std::make_shared<const PaintSurface>(*std::move(made));
  for (const auto& each : surfaces_)
    if (each->mesh == mesh && each->frame == frame) each->surface = ready;
  return ready;
}

bool Editor::rests_by_itself(NodeId id) const {
  const DocumentNode* const node = state().find(id);
  return node && node->node.mesh >= 0 && node->node.soft_body && !node->node.handle &&
         length(state().simulation.gravity) > 0.0;
}

namespace {

Editor::Ground made_ground(const Level& level, std::int32_t node, const dmat3& frame,
                           const std::filesystem::path& folder, const std::stop_token& stop,
                           const std::atomic<bool>* stopped) {
  const RestingMesh rest = resting_mesh(level, node, folder, stop);
  Editor::Ground out{.ready = true, .sag = rest.sag, .held = rest.held, .falls = rest.falls};
  if (auto surface = PaintSurface::make(rest.mesh, frame, stopped))
    out.surface = std::make_shared<const PaintSurface>(*std::move(surface));
  return out;
}

std::int32_t numbered(const Level& level, const std::string& name) {
  const auto at =
      std::find_if(level.nodes.begin(), level.nodes.end(), [&](const LevelNode& n) { return n.name == name; });
  return static_cast<std::int32_t>(at - level.nodes.begin());
}

}  // namespace

// The entry of a soft body as it stands now; a new one is not ready.
std::shared_ptr<Editor::Resting> Editor::resting_of(NodeId id) {
  auto wanted = std::make_shared<Resting>();
  wanted->node = state().nodes[state().place(id)];
  const auto mesh = static_cast<std::uint32_t>(wanted->node->node.mesh);
  wanted->mesh = state().meshes[mesh];
  wanted->to_world = state().to_world(id);
  wanted->gravity = state().simulation.gravity;
  for (const auto& [key, layer] : state().paint)
    if (key.mesh == mesh && key.channel == Channel::kPinned) wanted->pinned.push_back(layer);
  for (const auto& each : resting_)
    if (each->node == wanted->node && each->mesh == wanted->mesh && each->to_world == wanted->to_world &&
        each->gravity == wanted->gravity && each->pinned == wanted->pinned)
      return each;
  std::erase_if(resting_, [&](const auto& each) { return each->node->id == id; });
  resting_.push_back(wanted);
  return wanted;
}

Editor::Ground Editor::ground_of(NodeId id) {
  if (!rests_by_itself(id)) {
    const auto surface = surface_of(id);
    return {.surface = surface, .ready = surface || !jobs.running("surface " + std::to_string(id))};
  }
  const std::shared_ptr<Resting> entry = resting_of(id);
  const std::string job = "ground " + std::to_string(id);
  if (entry->ground.ready || jobs.running(job)) return entry->ground;
  auto level = std::make_shared<Level>(level_of(state()));
  jobs.start(job, "Preparing " + entry->node->node.name,
             [entry, level, folder = document.folder()](const Jobs::Stop& stop) {
               const Ground made = made_ground(*level, numbered(*level, entry->node->node.name), dmat3(entry->to_world),
                                               folder, stop.source.get_token(), &stop);
               return [entry, made](Editor&) { entry->ground = made; };
             });
  return entry->ground;
}

Editor::Ground Editor::ground_now(NodeId id) {
  if (!rests_by_itself(id)) return {.surface = surface_now(id), .ready = true};
  const std::shared_ptr<Resting> entry = resting_of(id);
  if (!entry->ground.ready) {
    const Level level = level_of(state());
    entry->ground = made_ground(level, numbered(level, entry->node->node.name), dmat3(entry->to_world),
                                document.folder(), {}, nullptr);
  }
  return entry->ground;
}

void Editor::copy() {
  if (selected.empty()) return;
  clipboard = state();
  copied = selected;
}

void Editor::cut() {
  copy();
  if (!selected.empty()) apply("Cut", without(state(), selected));
}

void Editor::paste() {
  std::vector<NodeId> ids;
  const DocumentNode* const active_one = active_node();
  const NodeId parent = active_one ? active_one->parent : kNoNode;
  if (apply("Paste", pasted(state(), clipboard, copied, parent, document.next_id(), &ids))) selected = ids;
}

void Editor::look_for_devices() {
  devices_looked_for = true;
  jobs.start(kDeviceJob, "",
             [](const Jobs::Stop&) { return [found = list_devices()](Editor& editor) { editor.devices = found; }; });
}

std::vector<std::string> Editor::device_requests() const {
  std::vector<std::string> all{"any-force", "any-force; mouse", "any-pose", "any-pose; mouse", "any"};
  for (const DeviceInfo& device : devices)
    if (device.missing.empty() && !device.id.empty()) all.push_back(full_id(device));
  const std::vector<std::string> drivers = driver_names();
  for (const std::string& driver : drivers)
    if (std::find(all.begin(), all.end(), driver) == all.end()) all.push_back(driver);
  return all;
}

}  // namespace pliant
