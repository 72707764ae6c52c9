// A modal question.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pliant {

struct Answer {
  std::string label, hint;
  std::function<void()> then;  // may be empty
};
struct Question {
  std::string title;
  std::vector<std::string> lines;
  std::vector<Answer> answers;  // the first is the default; Esc is the last
};

}  // namespace pliant
