// A driver with wrappers, from text: "falcon:0|delay=5ms|drop=10%".
//
//   NAME[:ID][|WRAPPER=VALUE[,KEY=VALUE...]]...     each wrapper wraps everything to its left
//
//   record=FILE[,seconds=60]        its samples and forces, into FILE when it is closed
//   replay=FILE                     its poses from FILE; zero is written to it
//   delay=5ms or delay=5[,written=] delays samples; with `written`, forces
//   jitter=2ms[,seed=1]             delays samples by a random time up to this
//   drop=10%[,written=][,seed=1]    drops samples, forces at random
//   quantise=0.1mm[,force=5mN]      quantises position, force
//   gain=2[,force=2]                motion times 2, force times 2 (the same factor by default)
//   scale=2                         motion times 2, force unchanged
//   frame=X:Y:Z                     rotated by angles about the world's x, then y, then z [degrees]
//   clutch=BUTTON                   0 to 31: while pressed the pose is frozen
//   border=40mm[,rate=4]            rate control beyond
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pliant/driver.h"

namespace pliant {

struct DeviceChain {
  std::unique_ptr<Driver> driver;  // not opened
  std::string id;                  // to open it with
  std::vector<std::string> notes;  // notes for the user, for instance a gain that does not preserve power
};

// From the registry. The error is one sentence.
Result<DeviceChain> make_device(const std::string& words);
// Wrappers only, in front of an existing driver; `words` without its name: "delay=5ms|drop=10%".
Result<DeviceChain> wrap(std::unique_ptr<Driver> driver, const std::string& words);

}  // namespace pliant
