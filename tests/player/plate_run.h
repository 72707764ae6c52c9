// Runs that press a plate of 300 N/m by script.
#pragma once

#include "tests/player/command.h"

namespace pliant::testing {

class Run : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj());
    write_text(folder / "press.csv", press_csv(0.002));
  }
  // Presses the plate by script, without pictures.
  Said press(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"run",   "plate.obj", "--probe",  "tip=script:press.csv",
                                       "--out", out,         "--frames", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return pliant(arguments);
  }
};

}  // namespace pliant::testing
