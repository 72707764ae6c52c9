// The scene tree: all nodes with their kinds and hierarchy.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "content/keys/extension_table.h"
#include "editor/panels/panels.h"
#include "editor/panels/tree_rows.h"
#include "runtime/printable.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

bool holds(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// "deformable, light"
std::string kind_of(const LevelNode& node) {
  std::string text;
  const auto add = [&](const char* word) { text += (text.empty() ? "" : ", ") + std::string(word); };
  for (const Extension& each : extension_table())
    if (!each.on_scene && each.present(&node)) {
      std::string word = each.name;
      std::replace(word.begin(), word.end(), '_', ' ');
      add(word.c_str());
    }
  if (node.light) add("light");
  if (node.camera) add("camera");
  return text.empty() && node.mesh >= 0 ? "mesh" : text;
}
bool matches(const DocumentNode& node, const std::string& part) {
  return holds(node.node.name, part) || holds(kind_of(node.node), part);
}

void row_menu(Editor& editor, const DocumentNode& node) {
  if (ui::menu_item("Rename", "F2")) editor.renaming = node.id;
  if (ui::menu_item("Duplicate")) {
    std::vector<NodeId> ids;
    if (editor.apply("Duplicate", duplicated(editor.state(), editor.selected, editor.document.next_id(), &ids)))
      editor.selected = ids;
  }
  if (ui::menu_item("Frame")) editor.frame_selected();
  if (ui::menu_item("Isolate", nullptr, !editor.view.isolated.empty()))
    editor.view.isolated = editor.view.isolated.empty() ? editor.selected : std::vector<NodeId>{};
  ImGui::Separator();
  if (ui::menu_item("Delete")) editor.apply("Delete", without(editor.state(), editor.selected));
}

// At the right end of the row, where there is room.
void draw_kind(const std::string& kind, const std::string& name) {
  if (kind.empty()) return;
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  const float wide = ImGui::CalcTextSize(kind.c_str()).x, room = ImGui::GetWindowContentRegionMax().x -
                                                                 ImGui::GetItemRectMin().x + ImGui::GetWindowPos().x -
                                                                 ImGui::CalcTextSize(name.c_str()).x - ui::px(56);
  if (wide < room) {
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - wide - ui::px(4));
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(ui::palette().faint, "%s", kind.c_str());
  }
  ImGui::PopFont();
}

class TreePanel : public Panel {
 public:
  const char* name() const override { return "Scene"; }
  Place place() const override { return Place::kLeft; }

  void draw(Editor& editor) override {
    ui::gap(2);
    ImGui::AlignTextToFramePadding();
    ImGui::PushFont(ui::font(ui::Type::kStrong));
    ImGui::TextUnformatted("Scene");
    ImGui::PopFont();
    ImGui::SameLine();
    ui::text_field("Search", search_, "Search nodes and components");
    ui::gap(2);
    // Its arrow keys move the selection through the rows.
    ImGui::BeginChild("nodes", {0, 0}, false, ImGuiWindowFlags_NoNavInputs);
    const State& state = editor.state();
    follow_selection(editor);
    if (ImGui::IsWindowFocused() && !ImGui::GetIO().WantTextInput && !ui::popup_is_open())
      rows_.take_keys(editor, search_.empty());
    // Children by parent, computed once per frame: a level may have thousands.
    below_.clear();
    for (const auto& each : state.nodes) below_[each->parent].push_back(each.get());
    rows_.begin();
    if (search_.empty())
      for (const DocumentNode* root : below_[kNoNode]) draw_node(editor, *root);
    else
      for (const auto& each : state.nodes)
        if (matches(*each, search_)) draw_row(editor, *each, true);
    if (state.nodes.empty()) ui::dim("Nothing here yet. Open an organ, or add something from the menu Add.");
    // A node dropped below all rows becomes a root.
    const ImVec2 rest = ImGui::GetContentRegionAvail();
    ImGui::InvisibleButton("below", {std::max(rest.x, 1.0f), std::max(rest.y, ui::px(24))});
    ui::known_as("below");
    if (ImGui::IsItemClicked()) editor.selected.clear();
    take_drop(editor, kNoNode);
    ImGui::EndChild();
    if (dropped_) {
      editor.apply("Move in the tree", reparented(editor.state(), dropped_->first, dropped_->second));
      dropped_.reset();
    }
    followed_ = editor.active();
  }

 private:
  // Scrolls to a selection made elsewhere, and unfolds its parents.
  void follow_selection(Editor& editor) {
    if (editor.renaming != kNoNode && renaming_ != editor.renaming) {
      const DocumentNode* const node = editor.state().find(editor.renaming);
      if (!node) editor.renaming = kNoNode;
      rows_.reveal = renaming_ = editor.renaming;
      if (node) new_name_ = node->node.name;
      starts_ = true;
      search_.clear();
    }
    if (editor.active() != followed_ && editor.active() != kNoNode) rows_.reveal = editor.active();
    if (rows_.reveal == kNoNode) return;
    const DocumentNode* node = editor.state().find(rows_.reveal);
    for (NodeId above = node ? node->parent : kNoNode; above != kNoNode;) {
      rows_.fold[above] = true;
      const DocumentNode* const parent = editor.state().find(above);
      above = parent ? parent->parent : kNoNode;
    }
  }

  void draw_node(Editor& editor, const DocumentNode& node) {
    const bool open = draw_row(editor, node, below_[node.id].empty());
    if (!open || below_[node.id].empty()) return;
    for (const DocumentNode* child : below_[node.id]) draw_node(editor, *child);
    ImGui::TreePop();
  }

  void draw_name_field(Editor& editor, const DocumentNode& node) {
    if (starts_) ImGui::SetKeyboardFocusHere();
    starts_ = false;
    const bool done = ui::text_field("Name", new_name_, "", 0,
                                     ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (rows_.reveal == node.id) ImGui::SetScrollHereY();
    const bool left = ImGui::IsItemDeactivated(), given_up = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (done || left) {
      if (!given_up && !new_name_.empty() && new_name_ != node.node.name)
        editor.apply("Rename", renamed(editor.state(), node.id, new_name_));
      renaming_ = editor.renaming = kNoNode;
      ImGui::SetWindowFocus();  // the arrow keys continue from here
    }
    if (rows_.reveal == node.id) rows_.reveal = kNoNode;
  }

  // The mouse on the row drawn last.
  void answer_row(Editor& editor, const DocumentNode& node, const std::string& shown) {
    const bool toggled = ImGui::IsItemToggledOpen();
    if (ImGui::IsItemHovered()) {
      editor.hovered = node.id;
      if (ImGui::IsMouseDoubleClicked(0)) {
        editor.select(node.id);
        editor.frame_selected();
      }
    }
    if (ImGui::IsItemClicked() && !toggled) {
      const ImGuiIO& io = ImGui::GetIO();
      if (io.KeyShift && editor.active() != kNoNode)
        rows_.select_range(editor, node.id);
      else
        editor.select(node.id, io.KeyCtrl);
    }
    if (ImGui::BeginPopupContextItem("row menu")) {
      if (!editor.is_selected(node.id)) editor.select(node.id);
      row_menu(editor, node);
      ImGui::EndPopup();
    }
    if (ImGui::BeginDragDropSource()) {
      if (!editor.is_selected(node.id)) editor.select(node.id);
      ImGui::SetDragDropPayload("node", &node.id, sizeof(node.id));
      ImGui::TextUnformatted(shown.c_str());
      ImGui::EndDragDropSource();
    }
  }

  bool draw_row(Editor& editor, const DocumentNode& node, bool leaf) {
    const std::string shown = printable(node.node.name);
    ui::draws(shown);
    ImGui::PushID(static_cast<int>(node.id));
    const ui::Scope scope(node.node.name);
    rows_.order.push_back(node.id);
    if (renaming_ == node.id) {
      draw_name_field(editor, node);
      ImGui::PopID();
      return false;
    }
    if (!leaf) rows_.parents.insert(node.id);
    if (const auto fold = rows_.fold.find(node.id); fold != rows_.fold.end()) {
      ImGui::SetNextItemOpen(fold->second);
      rows_.fold.erase(fold);
    }
    ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth |
                               ImGuiTreeNodeFlags_FramePadding | ImGuiTreeNodeFlags_DefaultOpen;
    if (editor.is_selected(node.id)) flags |= ImGuiTreeNodeFlags_Selected;
    if (leaf) flags |= ImGuiTreeNodeFlags_Leaf | ImGuiTreeNodeFlags_NoTreePushOnOpen;
    if (!node.node.in_scene) ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().faint);
    const bool open = ImGui::TreeNodeEx("node", flags, "%s", shown.c_str());
    if (!node.node.in_scene) ImGui::PopStyleColor();
    ui::known_as("row");
    if (open && !leaf) rows_.open.insert(node.id);
    if (rows_.reveal == node.id) {
      if (!ImGui::IsItemVisible() || ImGui::GetItemRectMax().y > ImGui::GetWindowPos().y + ImGui::GetWindowHeight() ||
          ImGui::GetItemRectMin().y < ImGui::GetWindowPos().y)
        ImGui::SetScrollHereY();
      rows_.reveal = kNoNode;
    }
    answer_row(editor, node, shown);
    take_drop(editor, node.id);
    draw_kind(kind_of(node.node), shown);
    ImGui::PopID();
    return open;
  }

  void take_drop(const Editor& editor, NodeId onto) {
    if (ImGui::BeginDragDropTarget()) {
      if (ImGui::AcceptDragDropPayload("node")) dropped_ = {editor.selected, onto};
      ImGui::EndDragDropTarget();
    }
    if (onto == kNoNode) rows_.before = rows_.order;
  }

  std::string search_, new_name_;
  NodeId renaming_ = kNoNode;
  NodeId followed_ = kNoNode;  // the selection when last drawn
  TreeRows rows_;
  bool starts_ = false;
  std::map<NodeId, std::vector<const DocumentNode*>> below_;
  std::optional<std::pair<std::vector<NodeId>, NodeId>> dropped_;
};

}  // namespace

std::unique_ptr<Panel> make_tree_panel() {
  return std::make_unique<TreePanel>();
}

}  // namespace pliant
