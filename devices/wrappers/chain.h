// A driver by its words, wrappers and all: "falcon:0|delay=5ms|drop=10%".
//
//   NAME[:ID][|WRAPPER=VALUE[,KEY=VALUE...]]...     each wrapper stands in front of what is left of it
//
//   record=FILE[,seconds=60]        what it says and is told, into FILE when it is closed
//   replay=FILE                     its poses from FILE; it is written zero
//   delay=5ms or delay=5[,written=] samples later; forces later
//   jitter=2ms[,seed=1]             samples up to so much later, by chance
//   drop=10%[,written=][,seed=1]    samples, forces lost by chance
//   quantise=0.1mm[,force=5mN]      in counts
//   gain=2[,force=2]                motion times 2, force times 2 (as much, unless said)
//   scale=2                         motion times 2, force as it is
//   frame=X:Y:Z                     turned by angles about the world's x, then y, then z [degrees]
//   clutch=BUTTON                   0 to 31: while it is down the pose stands still
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
