// Ctrl-C asks a run to end cleanly; a second one ends it at once.
#pragma once

namespace pliant {

class Interrupt {
 public:
  Interrupt();   // from now on SIGINT and SIGTERM only set a flag
  ~Interrupt();  // as before
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  bool requested() const;
};

}  // namespace pliant
