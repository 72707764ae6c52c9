#include "editor/panels/source_fields.h"

#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr const char* kLevel = "as the level says";
constexpr const char* kScript = "script";
constexpr const char* kOrbit = "orbit";
constexpr const char* kNoSource = "nothing";

std::string source_word(const PlaySource& source) {
  switch (source.kind) {
    case PlaySource::Kind::kLevel:
      return kLevel;
    case PlaySource::Kind::kMouse:
      return kMouseSource;
    case PlaySource::Kind::kScript:
      return kScript;
    case PlaySource::Kind::kOrbit:
      return kOrbit;
    case PlaySource::Kind::kNone:
      return kNoSource;
    case PlaySource::Kind::kDriver:
      return source.what;
  }
  return {};
}

PlaySource source_of(const std::string& word, const PlaySource& before) {
  if (word == kLevel) return {PlaySource::Kind::kLevel, {}};
  if (word == kMouseSource) return {PlaySource::Kind::kMouse, {}};
  if (word == kOrbit) return {PlaySource::Kind::kOrbit, {}};
  if (word == kNoSource) return {PlaySource::Kind::kNone, {}};
  if (word == kScript)
    return {PlaySource::Kind::kScript, before.kind == PlaySource::Kind::kScript ? before.what : std::string()};
  return {PlaySource::Kind::kDriver, word};
}

std::vector<std::string> effector_names(const Editor& editor, const Play& play) {
  std::vector<std::string> names;
  if (play.on() && !play.status().effectors.empty()) {
    for (const PlayEffector& each : play.status().effectors) names.push_back(each.name);
  } else {
    for (const auto& each : editor.state().nodes)
      if (each->node.probe || each->node.handle) names.push_back(each->node.name);
  }
  return names;
}

}  // namespace

void SourceFields::draw(Editor& editor, Play& play) {
  if (!ui::section("What moves the probes")) return;
  const ui::Scope scope("source");
  const std::vector<std::string> names = effector_names(editor, play);
  std::vector<std::string> choices{kLevel, kMouseSource, kScript, kOrbit, kNoSource};
  if (!editor.devices_looked_for) editor.look_for_devices();
  for (const std::string& request : editor.device_requests()) choices.push_back(request);
  if (names.empty()) ui::dim("The level has no probe and no tool.");
  for (const std::string& name : names) draw_source(play, name, choices);
  if (!play.on())
    ui::checkbox("A probe for the mouse", play.mouse_probe,
                 "Where nothing is moved by the mouse, a probe is added for it while the level is played. It is not "
                 "saved. Without it the hash is that of `pliant run`.");
  ui::dim("Press and hold on a surface to touch it, drag to slide, wheel for the depth; Ctrl and wheel stays in.");
  ui::gap(4);
}

void SourceFields::draw_source(Play& play, const std::string& name, const std::vector<std::string>& choices) {
  PlaySource source = play.sources.contains(name) ? play.sources.at(name) : PlaySource{};
  std::string word = source_word(source);
  for (const PlayEffector& each : play.status().effectors)  // the probe added for it
    if (play.on() && each.name == name && each.source == kMouseSource) word = kMouseSource;
  const float left = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
  ui::label(printable(name).c_str());
  ImGui::SameLine(left + 0.42f * wide);
  if (ui::combo(name.c_str(), word, choices)) {
    const PlaySource next = source_of(word, source);
    if (next.kind == PlaySource::Kind::kMouse)
      for (auto& [other, its] : play.sources)
        if (its.kind == PlaySource::Kind::kMouse) its = {PlaySource::Kind::kNone, {}};
    play.set_source(name, next);
    source = next;
  }
  if (source.kind != PlaySource::Kind::kScript) return;
  std::string& file = files_[name];
  if (file.empty()) file = source.what;
  ui::text_field((name + " file").c_str(), file, "FILE.csv: time_s,x,y,z", 0);
  if (ImGui::IsItemDeactivatedAfterEdit() && file != source.what) {
    source.what = file;
    play.set_source(name, source);
  }
}

}  // namespace pliant
