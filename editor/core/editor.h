// The state of the editor that all panels share: document, selection, view settings, running work. It needs no window,
// so tests use it like the panels.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "content/level/finding.h"
#include "editor/core/jobs.h"
#include "editor/document/document.h"
#include "editor/document/edits.h"
#include "editor/paint/paint_surface.h"
#include "editor/viewport/view_camera.h"
#include "editor/viewport/view_settings.h"
#include "pliant/driver.h"

namespace pliant {

// A line of the console; the newest is also shown over the viewport for a while.
struct Said {
  double time = 0.0;  // [s] since the editor's start
  Severity severity = Severity::kNote;
  std::string text;
  int times = 1;  // repeated in a row
};

// A remedy that a finding offers.
struct QuickFix {
  std::string label;
  std::function<Result<State>(const State&, NodeId& next_id)> fix;
};
struct EditorFinding {
  Finding finding;
  NodeId node = kNoNode;  // that it concerns
  std::optional<QuickFix> fix;
};

class Painting;

class Editor {
 public:
  Editor();
  ~Editor();

  // --- Document
  Document document;
  const State& state() const { return document.state(); }
  // All panels and tools change the level only through this; reports errors. True: the level is as requested.
  bool apply(const std::string& what, Result<State> next, const std::string& gesture = {});
  // Replaces the document without asking.
  void take(Document next);
  std::uint64_t documents = 0;                                                              // number of documents taken
                                                                                            // so far
  void revert_to(Level level, const FileStamp& stamp, const std::string& what = "Revert");  // as Document; keeps the
                                                                                            // selection, by name
  void go_to_step(std::size_t step);                                                        // in the document's history
  void undo();
  void redo();
  void drop_gesture(const std::string& gesture);  // undoes the drag in progress
  // Called after every change of the shown state, including undo and redo.
  std::vector<std::function<void(const State& before, const State& after)>> on_change;

  // --- Selection
  std::vector<NodeId> selected;  // the last one is active
  NodeId hovered = kNoNode;
  NodeId renaming = kNoNode;  // the node being renamed in the tree
  NodeId active() const { return selected.empty() ? kNoNode : selected.back(); }
  const DocumentNode* active_node() const { return document.state().find(active()); }
  bool is_selected(NodeId id) const;
  void select(NodeId id, bool add = false);  // kNoNode: none; `add` toggles one
  void forget_gone();                        // removes deleted nodes from the selection

  // --- Messages
  void say(const std::string& text, Severity severity = Severity::kNote);
  std::deque<Said> said;  // oldest first, at most kMostSaid
  static constexpr std::size_t kMostSaid = 2000;
  double now = 0.0;  // [s] since the editor's start; of the frame

  // --- Findings of the current document
  std::vector<EditorFinding> findings;
  std::uint64_t found_at = ~std::uint64_t{0};  // the revision they belong to
  std::vector<EditorFinding> run_findings;     // of the last run, until the next
  std::uint64_t files_read = 0;  // incremented when a referenced file (a script, a panorama) changes on disk

  // --- View
  ViewSettings view;
  CameraControl camera = CameraControl::before({});
  Box scene_box() const;  // [m] world
  void frame_selected();  // or all

  // --- Surfaces for painting and picking, by mesh and scale; built in the background
  // Null: not ready yet (it has been started); an error is reported once.
  std::shared_ptr<const PaintSurface> surface_of(NodeId id);
  // The same, but waits for it; null: it cannot be built.
  std::shared_ptr<const PaintSurface> surface_now(NodeId id);
  // The surface as it stands when the level begins: of a soft body that sags on its pins, at rest
  // (document/resting_mesh.h); of all else that of above.
  struct Ground {
    std::shared_ptr<const PaintSurface> surface;  // null: not ready yet, or it cannot be made
    bool ready = false;
    double sag = 0.0;  // [m] the farthest that it is from where it is drawn
    bool held = true, falls = false;
  };
  Ground ground_of(NodeId id);               // begins to prepare it
  Ground ground_now(NodeId id);              // at once, where it takes that long
  const std::unique_ptr<Painting> painting;  // the brush, and what is done with it (editor/core/painting.h)

  // --- Clipboard
  State clipboard;
  std::vector<NodeId> copied;
  void copy();
  void cut();
  void paste();

  // --- The edited path (core/path_editing.h)
  std::size_t path_key = 0;   // the active one
  double path_depth = 0.005;  // [m] of the next key
  double path_speed = 0.02;   // [m/s] on the way to the next key

  // --- Devices on this machine, from the last background search
  static constexpr const char* kDeviceJob = "devices";
  std::vector<DeviceInfo> devices;
  bool devices_looked_for = false;
  void look_for_devices();
  std::vector<std::string> device_requests() const;  // possible values of an `id`: kinds, then available ids

  Jobs jobs;
  std::string tool = "Select";          // the viewport's active tool
  bool playing = false;                 // a session is running
  std::function<void()> request_close;  // set by the program

 private:
  struct Surface {
    std::shared_ptr<const DocumentMesh> mesh;
    dmat3 frame{1};
    std::string job;
    std::shared_ptr<const PaintSurface> surface;  // null: in progress, or failed
    bool failed = false;
  };
  std::vector<std::shared_ptr<Surface>> surfaces_;
  // Of a soft body, and all that it rests by.
  struct Resting {
    std::shared_ptr<const DocumentNode> node;
    std::shared_ptr<const DocumentMesh> mesh;
    dmat4 to_world{1};
    dvec3 gravity{0};
    std::vector<PaintLayer> pinned;
    Ground ground;
  };
  bool rests_by_itself(NodeId id) const;  // a soft body that gravity may move
  std::shared_ptr<Resting> resting_of(NodeId id);
  std::vector<std::shared_ptr<Resting>> resting_;
};

}  // namespace pliant
