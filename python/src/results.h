// A contact of any kind with its names, as Session.contacts() returns it.
#pragma once

#include <pliant/session.h>

#include <string>
#include <vector>

namespace pliant_python {

struct Contact {
  std::string a, b;  // names; "": a probe whose name is not known
  pliant::dvec3 position{0}, normal{0}, force{0};
  double depth = 0.0;
  bool sliding = false;
};

// Of the session's newest state: probes on surfaces, then those of bodies.
std::vector<Contact> contacts_of(pliant::Session& session);

struct Hit {
  std::string object;
  pliant::QueryHit at;
};

}  // namespace pliant_python
