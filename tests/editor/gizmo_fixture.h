// Views of a gizmo, and nodes that it moves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "editor/core/editor.h"
#include "editor/viewport/gizmo_math.h"

namespace pliant::test {

inline GizmoPicture seen_from(dvec3 eye, dvec3 target, bool flat = false) {
  GizmoPicture picture{{.eye = eye, .target = target}, 0.0, 1280, 720};
  if (flat) picture.orthographic = 2.0 * length(target - eye) * std::tan(0.5 * static_cast<double>(picture.view.yfov));
  return picture;
}
inline dvec2 pixel(const GizmoPicture& picture, dvec3 place) {
  const auto at = picture.pixel(place);
  EXPECT_TRUE(at.has_value());
  return at ? dvec2(*at) : dvec2(0);
}

// Nodes without meshes, with the hierarchy given by `parent`.
struct Tree {
  Editor editor;
  NodeId add(const std::string& name, const LocalTransform& local, NodeId parent = kNoNode) {
    LevelNode node;
    node.name = name;
    node.local = local;
    const NodeId id = editor.document.new_id();
    EXPECT_TRUE(editor.apply("Add", with_node(editor.state(), id, parent, node)));
    return id;
  }
  dvec3 place(NodeId id) const { return dvec3(editor.state().to_world(id)[3]); }
};

}  // namespace pliant::test
