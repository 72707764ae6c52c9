// The mouse on soft and rigid bodies in an invisible window: it presses and pulls them as it presses surfaces.
#include <algorithm>
#include <cmath>

#include "content/files/image.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class SoftMouseWindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    write_text(folder / "block.obj", block_obj());
  }
  // A cube of 60 mm about the origin, 8 x 8 squares per side.
  static std::string block_obj() {
    std::ostringstream obj;
    obj << "o block\n";
    int first = 1;
    constexpr int n = 8;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        for (int j = 0; j <= n; ++j)
          for (int i = 0; i <= n; ++i) {
            double p[3];
            p[axis] = 0.03 * side;
            p[(axis + 1) % 3] = 0.06 * i / n - 0.03;
            p[(axis + 2) % 3] = 0.06 * j / n - 0.03;
            obj << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
          }
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) {
            const int a = first + j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (side > 0)
              obj << "f " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
            else
              obj << "f " << a << ' ' << d << ' ' << c << ' ' << b << '\n';
          }
        first += (n + 1) * (n + 1);
      }
    return obj.str();
  }
  // A level with the block as tissue, and a probe that the mouse moves.
  void author(const std::string& pin) const {
    const Said said = pliant({"author", "block.obj", "--soft", "block", "--preset", "gelatin-5", "--tool", "none",
                              "--pin", pin, "-o", "level.glb", "--force"});
    ASSERT_EQ(said.status, 0) << said.err;
  }
  Said shown(const std::string& events, const std::vector<std::string>& more = {}) const {
    write_text(folder / "events.csv", "time_s,event,args\n0.0,key,Tab\n" + events);
    std::vector<std::string> all{"run",        "level.glb", "--probe", "probe=mouse", "--window", "--input",
                                 "events.csv", "--out",     "out",     "--size",      "240x160",  "--force"};
    all.insert(all.end(), more.begin(), more.end());
    return pliant(all, "ASAN_OPTIONS=detect_leaks=0 timeout 60 xvfb-run -a -s '-screen 0 400x300x24'");
  }
  Json probe() const { return report("out")["probes"][0]; }
  // Mean difference of two screenshots, 0 to 255.
  double difference(const char* a, const char* b) const {
    const auto x = load_image(folder / "out" / a), y = load_image(folder / "out" / b);
    if (!x || !y || x->rgba.size() != y->rgba.size()) return 255.0;
    double sum = 0;
    for (std::size_t i = 0; i < x->rgba.size(); ++i) sum += std::abs(int{x->rgba[i]} - int{y->rgba[i]});
    return sum / (0.75 * static_cast<double>(x->rgba.size()));
  }
};

const std::string kPull =
    "0.0,move,120 80\n1.0,press,control\n1.2,move,124 70\n1.4,move,128 60\n1.6,move,134 50\n1.8,move,140 45\n"
    "3.0,key,F12\n3.5,release,\n5.5,key,F12\n6.0,close,\n";

TEST_F(SoftMouseWindowTest, PressesAPinnedBodyAndFeelsIt) {
  author("bottom");
  const Said said = shown("0.0,move,120 80\n1.0,press,\n3.0,release,\n3.5,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(probe()["contact_ticks"], 100);
  EXPECT_GT(probe()["max_force_N"], 0.03);
  EXPECT_LE(probe()["max_force_N"], 3.3 + 1e-9);
}

TEST_F(SoftMouseWindowTest, PullsAPinnedBodyWhichSwingsBackWhenItIsLetGo) {
  author("bottom");
  const Said said = shown(kPull);
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(probe()["contact_ticks"], 500);
  EXPECT_GT(probe()["max_force_N"], 0.1);
  EXPECT_LE(probe()["max_force_N"], 3.3 + 1e-9);
  EXPECT_GT(difference("screenshot-001.png", "screenshot-002.png"), 0.5) << "drawn out, and back again";
}

TEST_F(SoftMouseWindowTest, PullsABodyThatNothingHolds) {
  author("none");
  const Said said = shown(kPull, {"--set", "*.simulation.gravity=0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(probe()["contact_ticks"], 300);
  EXPECT_GT(difference("screenshot-001.png", "screenshot-002.png"), 0.0);
}

}  // namespace
}  // namespace pliant::testing
