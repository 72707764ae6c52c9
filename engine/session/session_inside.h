// Internal access to a Session for programs of this project that show and control it (editor/play): on its owner's
// thread, under the rules of session_parts.h.
#pragma once

#include "engine/session/session_parts.h"

namespace pliant {

struct SessionInside {
  static Session::Parts& of(Session& session) { return *session.parts_; }
};

}  // namespace pliant
