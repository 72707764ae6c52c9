// Effectors and objects of a session by name.
#include "engine/session/session_run.h"

namespace pliant {

SessionEffector* SessionRun::find_effector(const std::string& name) {
  for (SessionEffector& effector : effectors)
    if (effector.name == name) return &effector;
  return nullptr;
}
const SessionEffector* SessionRun::find_effector(const std::string& name) const {
  return const_cast<SessionRun*>(this)->find_effector(name);
}

Error SessionRun::unknown_effector(const std::string& name) const {
  std::string names;
  for (const SessionEffector& effector : effectors) names += (names.empty() ? "" : ", ") + effector.name;
  return {"`" + name + "`", names.empty() ? "the scene has no probe and no tool" : "is no probe or tool",
          names.empty() ? "add one with Scene::add_probe" : "they are: " + names, "name.unknown"};
}

Result<Entity> SessionRun::find_object(const std::string& name) const {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i] == name) return object_entities[i];
  std::string names;
  for (const std::string& object : objects) names += (names.empty() ? "" : ", ") + object;
  return Error{"`" + name + "`", names.empty() ? "the scene has no object" : "is no object",
               names.empty() ? "add one with Scene::add_surface" : "they are: " + names, "name.unknown"};
}

}  // namespace pliant
