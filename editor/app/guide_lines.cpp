#include "editor/app/guide_lines.h"

#include "content/files/file_io.h"
#include "content/level/script.h"

namespace pliant {

std::vector<vec3> guide_points(const Path& path) {
  std::vector<vec3> points;
  const std::size_t every = 1 + path.rows.size() / kMostGuideCorners;
  for (std::size_t i = 0; i < path.rows.size(); i += every) points.push_back(vec3(path.rows[i].position));
  if (!path.rows.empty() && (path.rows.size() - 1) % every != 0) points.push_back(vec3(path.rows.back().position));
  return points;
}

void GuideLines::update(Editor& editor) {
  if (document_ != editor.documents || files_read_ != editor.files_read) {
    all_ = std::make_shared<All>();  // jobs that are on their way fill the old one
    document_ = editor.documents;
    files_read_ = editor.files_read;
  }
  for (const auto& each : editor.state().nodes) {
    const LevelNode& node = each->node;
    if (!node.effect || node.effect->kind != EffectKind::kGuidance || node.effect->path.empty()) continue;
    const std::string& name = node.effect->path;
    if (!all_->emplace(name, nullptr).second) continue;
    const Result<std::filesystem::path> file = confined_path(editor.document.folder(), name);
    if (!file) continue;  // a finding says so
    editor.jobs.start("guide " + name, "", [name, file = *file, all = all_](const Jobs::Stop&) {
      const Result<Path> path = load_script(file);
      auto points = std::make_shared<const std::vector<vec3>>(path ? guide_points(*path) : std::vector<vec3>());
      return [name, points, all](Editor&) { (*all)[name] = points; };
    });
  }
}

}  // namespace pliant
