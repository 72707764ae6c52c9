// Make it soft: a preview of the selected mesh as tissue, its pins, its material, and instruments to touch it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "content/level/soft_preview.h"
#include "editor/app/add.h"
#include "editor/app/app.h"
#include "engine/choice/pin_advice.h"
#include "systems/soft/body/equilibrium.h"

namespace pliant {

// The inputs of a preview.
struct PreviewInputs {
  std::shared_ptr<const DocumentMesh> mesh;
  dmat4 to_world{1};
  Json soft, handle;
  dvec3 gravity{0};
  bool operator==(const PreviewInputs&) const = default;
};

class SoftPanel : public Panel {
 public:
  explicit SoftPanel(App& app) : app_(app) {}
  const char* name() const override { return "Tissue"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override;

 private:
  void draw_kind(Editor& editor, const DocumentNode& node);
  // Makes an organ of several nested meshes soft, in one click.
  void draw_organ(Editor& editor, const DocumentNode& node);
  void draw_material(Editor& editor, const DocumentNode& node);
  void draw_pins(Editor& editor, const DocumentNode& node);
  void draw_instruments(Editor& editor, const DocumentNode& node);

  // The preview (soft_lattice.cpp).
  void draw_lattice(Editor& editor, const DocumentNode& node);
  void draw_figures(Editor& editor, const DocumentNode& node);
  // Shows a button for a finding's remedy, if there is one.
  void offer(Editor& editor, const DocumentNode& node, const std::string& code);
  // Starts a preview if the inputs have changed.
  void ask(Editor& editor, const DocumentNode& node);
  // The edges of its tetrahedra with these nodes [m] object frame, in the viewport.
  void show_edges(const Editor& editor, const DocumentNode& node, const std::vector<dvec3>& nodes, vec4 color);

  // Gravity (soft_gravity.cpp): the equilibrium on its pins, before playing.
  void draw_gravity(Editor& editor, const DocumentNode& node);
  // Suggests sides to pin, the smallest sufficient one first.
  void draw_advice(Editor& editor, const DocumentNode& node);

  App& app_;
  double share_ = 0.15;  // [1]
  PreviewInputs wanted_, asked_;
  double wanted_at_ = 0.0;  // [s]
  std::optional<SoftPreview> preview_;
  dmat4 to_object_{1};
  bool shown_ = false;
  std::optional<Equilibrium> sag_;  // of the preview
  std::optional<Unloaded> unloaded_;
  std::string doubt_;
  bool show_sag_ = false;
  std::optional<std::vector<PinAdvice>> advice_;
  NodeId advice_of_ = kNoNode;
  std::optional<Error> trouble_;
};

// A row of two columns; `bad`: in the colour of a warning.
void soft_figure(const char* what, const std::string& value, bool bad = false);
inline vec4 shown_as(const ImVec4& c, float alpha) {
  return {c.x, c.y, c.z, alpha};
}

}  // namespace pliant
