#include "lab/console/standard_streams.h"
#include "player/verbs/command_line.h"

int main(int argc, char** argv) {
  pliant::prepare_standard_streams();
  return pliant::command_line(argc, argv);
}
