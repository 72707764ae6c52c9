// Actions of the menu Add; the added node becomes selected.
#pragma once

#include "content/author/instruments.h"
#include "content/author/shapes.h"
#include "editor/core/editor.h"

namespace pliant {

// An edit of content/author on a node; `select_new`: what it added becomes selected.
using NodeEdit = std::function<Status(Level&, std::int32_t node)>;
bool author_node(Editor& editor, const std::string& what, const DocumentNode& node, const NodeEdit& edit,
                 bool select_new = false);
std::int32_t place_in(const Level& level, const std::string& name);  // -1: none

// In front of the camera, beside what is there.
void add_shape(Editor& editor, const SimpleShape& shape);
// All of the shown scene of a level or mesh, likewise; the first one keeps its place. `metres`: length of its unit.
bool add_level(Editor& editor, const std::string& name, Level level, double metres);
// Over the selected object, or the largest.
void add_instrument(Editor& editor, const Instrument& instrument);
const DocumentNode* touched_object(const Editor& editor);  // that one; null: none

// The view of a camera of the level. Its target is at the depth of the scene's middle.
Viewpoint view_of_camera(const Editor& editor, const DocumentNode& camera);
void look_through(Editor& editor, const DocumentNode& camera);
// The place of a node, below its parent, that looks as the viewport does.
LocalTransform camera_place(const Editor& editor, const DocumentNode& camera);

void add_empty(Editor& editor);
void add_probe(Editor& editor);   // above the selected object, or above all; moved by the mouse
void add_effect(Editor& editor);  // around the middle of the selected object, or of all
void add_light(Editor& editor);
void add_camera(Editor& editor);  // with the viewport's current view

}  // namespace pliant
