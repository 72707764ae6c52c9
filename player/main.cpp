#include "player/verbs/command_line.h"

int main(int argc, char** argv) {
  return pliant::command_line(argc, argv);
}
