// The order of input events, however many arrive within one frame.
#include "editor/ui/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pliant::ui {
namespace {

using ::testing::ElementsAre;

InputEvent event(InputKind kind, int key = 0, std::uint8_t modifiers = 0) {
  InputEvent out;
  out.kind = kind;
  out.key = key;
  out.modifiers = modifiers;
  return out;
}
InputEvent down(int key, std::uint8_t modifiers = 0) {
  return event(InputKind::kKey, key, modifiers);
}
InputEvent up(int key) {
  return event(InputKind::kKeyUp, key);
}
InputEvent text(char c) {
  return event(InputKind::kText, c);
}

// The events of each frame, as symbols: M move, P press, R release, W wheel, v key down, ^ key up, a letter for itself.
std::vector<std::string> frames(const std::vector<InputEvent>& events, bool typing) {
  InputQueue queue;
  queue.add(events, 0.0);
  std::vector<std::string> all;
  while (!queue.empty() && all.size() < 100) {
    std::string signs;
    for (const ArrivedInput& each : queue.take(typing))
      signs += each.event.kind == InputKind::kText ? static_cast<char>(each.event.key)
                                                   : "MPRWv^tDfcw"[static_cast<std::size_t>(each.event.kind)];
    EXPECT_FALSE(signs.empty()) << "a frame that takes nothing would wait for ever";
    if (signs.empty()) break;
    all.push_back(signs);
  }
  return all;
}

TEST(InputQueue, APressAndItsReleaseWithinOneFrameAreBothSeen) {
  const std::vector<InputEvent> click{event(InputKind::kMove), event(InputKind::kPress), event(InputKind::kRelease)};
  EXPECT_THAT(frames(click, false), ElementsAre("M", "P", "R"));
  EXPECT_THAT(frames({down(GLFW_KEY_ENTER), up(GLFW_KEY_ENTER)}, false), ElementsAre("v", "^"));
}

TEST(InputQueue, CharactersComeAtOnceAndCommandsBetweenThemKeepTheirPlace) {
  std::vector<InputEvent> typed;
  for (const char c : {'a', 'b', 'c'}) {
    typed.push_back(down(c - 32));
    typed.push_back(text(c));
    typed.push_back(up(c - 32));
  }
  EXPECT_THAT(frames(typed, true), ElementsAre("va^vb^vc^"));
  EXPECT_THAT(frames({text('a'), down(GLFW_KEY_BACKSPACE), up(GLFW_KEY_BACKSPACE), text('b')}, true),
              ElementsAre("a", "v", "^b"));
  EXPECT_THAT(frames({text('a'), event(InputKind::kPress), event(InputKind::kRelease), text('b')}, true),
              ElementsAre("a", "P", "R", "b"));
}

TEST(InputQueue, AKeyThatMayTakeAToolIsAnsweredBeforeWhatFollows) {
  // M, then x: the tool must be active before it receives its axis.
  EXPECT_THAT(frames({down('M'), text('m'), up('M'), down('X'), text('x'), up('X')}, false),
              ElementsAre("vm", "^vx", "^"));
}

TEST(InputQueue, ModifiersHoldForTheKeyTheyWerePressedWith) {
  EXPECT_THAT(frames({down(GLFW_KEY_LEFT_CONTROL), down('A', kControl), up(GLFW_KEY_LEFT_CONTROL), up('A')}, true),
              ElementsAre("vv", "^^"));
}

TEST(InputQueue, TheSameKeyTwiceIsTwice) {
  EXPECT_THAT(frames({down(GLFW_KEY_DOWN), up(GLFW_KEY_DOWN), down(GLFW_KEY_DOWN), up(GLFW_KEY_DOWN)}, false),
              ElementsAre("v", "^", "v", "^"));
}

TEST(InputQueue, MovesAreOneAndADragKeepsItsOrder) {
  EXPECT_THAT(frames({event(InputKind::kMove), event(InputKind::kMove), event(InputKind::kPress),
                      event(InputKind::kMove), event(InputKind::kMove), event(InputKind::kRelease)},
                     false),
              ElementsAre("MM", "P", "MM", "R"));
}

}  // namespace
}  // namespace pliant::ui
