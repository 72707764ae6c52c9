// Arguments in, exit status out.
#pragma once

namespace pliant {

int command_line(int argc, const char* const* argv);

}  // namespace pliant
