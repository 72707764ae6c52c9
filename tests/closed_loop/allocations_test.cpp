// The tick path of wrappers and of the simulated device does not allocate.
#include <gtest/gtest.h>

#include <filesystem>

#include "devices/simulated/simulated_device.h"
#include "devices/wrappers/chain.h"
#include "scenes/count_allocations.h"

namespace pliant {
namespace {

TEST(Allocations, AChainOfEveryWrapperReadsAndWritesWithoutMemory) {
  register_simulated();
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pliant_allocations.csv";
  std::filesystem::remove(file);
  auto chain = make_device(
      "simulated:omni,clock=tick,push=0:-1:0|delay=5ms,written=2ms|jitter=3ms|drop=10%,written=10%|"
      "quantise=0.1mm|gain=2|frame=10:20:30|clutch=3|border=40mm|record=" +
      file.string() + ",seconds=100ms");
  ASSERT_TRUE(chain) << chain.error().message();
  ASSERT_TRUE(chain->driver->open(chain->id));
  std::uint64_t allocations = 0, samples = 0;
  {
    const CountAllocations count;
    for (int i = 0; i < 1000; ++i) {
      DeviceSample sample;
      samples += chain->driver->read(sample);
      chain->driver->write({dvec3(0, i % 5, 0), dvec3(0), 0.0});
    }
    allocations = count.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(samples, 300u);
  chain->driver->close();
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pliant
