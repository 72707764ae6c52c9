#include "devices/ports/udp_port.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

const UdpAddress kAnyPort{"127.0.0.1", "0"};
UdpAddress local(int port) {
  return {"127.0.0.1", std::to_string(port)};
}
Result<std::size_t> hear(UdpPort& port, std::string& text) {
  std::uint8_t bytes[64];
  auto got = port.receive(bytes, 5.0);
  if (got) text.assign(bytes, bytes + *got);
  return got;
}
Status say(UdpPort& port, std::string_view text) {
  return port.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(UdpPort, AnAddressIsAPortWithOrWithoutAHost) {
  EXPECT_EQ(parse_udp_address("17")->host, "127.0.0.1");
  EXPECT_EQ(parse_udp_address("10.0.0.1:17")->host, "10.0.0.1");
  EXPECT_EQ(parse_udp_address("[::1]:17")->host, "::1");
  EXPECT_EQ(parse_udp_address("[::1]:17")->port, "17");
  for (const char* bad : {"", ":", "host:", ":17", "::1:17", "70000", "-1", "1x", "host:1 ", "0x10"})
    EXPECT_FALSE(parse_udp_address(bad)) << bad;
  EXPECT_EQ(parse_udp_address("here").error().message(),
            "'here': is no address; write PORT, ADDRESS:PORT or [IPV6]:PORT, such as 192.168.1.7:17716");
}

TEST(UdpPort, PacketsGoBothWaysAndNobodyElseIsHeard) {
  auto device = UdpPort::listen(kAnyPort);
  ASSERT_TRUE(device);
  auto engine = UdpPort::connect(local((*device)->port()));
  auto stranger = UdpPort::connect(local((*device)->port()));
  ASSERT_TRUE(engine && stranger);
  std::string text;
  ASSERT_TRUE(say(**device, "to nobody"));
  ASSERT_TRUE(say(**engine, "hello"));
  ASSERT_TRUE(hear(**device, text));
  EXPECT_EQ(text, "hello");
  (*device)->take_peer();
  ASSERT_TRUE(say(**stranger, "me too"));
  ASSERT_TRUE(say(**engine, "again"));
  ASSERT_TRUE(hear(**device, text));
  EXPECT_EQ(text, "again");
  EXPECT_EQ((*device)->strangers(), 1u);
  ASSERT_TRUE(say(**device, "welcome"));
  ASSERT_TRUE(hear(**engine, text));
  EXPECT_EQ(text, "welcome");
  // Another sender that knows the engine's port is not its device.
  auto forger = UdpPort::connect(local((*engine)->port()));
  ASSERT_TRUE(forger);
  ASSERT_TRUE(say(**forger, "forged"));
  ASSERT_TRUE(say(**device, "true"));
  ASSERT_TRUE(hear(**engine, text));
  EXPECT_EQ(text, "true");
}

TEST(UdpPort, APeerThatIsNotThereIsSilenceAndNoError) {
  auto device = UdpPort::listen(kAnyPort);
  ASSERT_TRUE(device);
  auto engine = UdpPort::connect(local((*device)->port()));
  ASSERT_TRUE(engine);
  device->reset();
  std::uint8_t bytes[8];
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(say(**engine, "anyone?"));
    const auto got = (*engine)->receive(bytes, 0.0);
    ASSERT_TRUE(got);
    EXPECT_EQ(*got, 0u);
  }
}

TEST(UdpPort, WhatCannotBeOpenedSaysWhy) {
  auto first = UdpPort::listen(kAnyPort);
  ASSERT_TRUE(first);
  const auto second = UdpPort::listen(local((*first)->port()));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message().find("give another PORT"), std::string::npos) << second.error().message();
  EXPECT_FALSE(UdpPort::connect({"no.such.host.invalid", "1"}));
}

}  // namespace
}  // namespace pliant
