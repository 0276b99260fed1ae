// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/connection.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/silence.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/comms/mavlink/test_link.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

std::string ErrorOf(const std::function<void()>& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorOfUrl(const std::string& url) {
  return ErrorOf([&] { Connection(url, {}); });
}

std::string Url(const std::string& scheme, int port) {
  return scheme + "://127.0.0.1:" + std::to_string(port);
}

// Both ends send until 'to' has heard 'count' heartbeats. Returns the number heard.
int Heartbeats(Connection* from, Connection* to, int count) {
  int heard = 0;
  const auto ignore = [](const mavlink::Packet&, Time) {};
  for (int i = 0; i < 1000 && heard < count; ++i) {
    from->Send(mavlink::Heartbeat{18, 8, 0, 0, 4, 3});
    from->Receive(milliseconds(1), ignore);
    to->Receive(milliseconds(2), [&](const mavlink::Packet& packet, Time received) {
      EXPECT_LE(received, Now());
      if (packet.As<mavlink::Heartbeat>()) ++heard;
    });
  }
  return heard;
}

void ExpectBothWays(Connection* a, Connection* b) {
  EXPECT_GE(Heartbeats(a, b, 3), 3);
  EXPECT_GE(Heartbeats(b, a, 3), 3);
  EXPECT_TRUE(a->is_connected());
  EXPECT_TRUE(b->is_connected());
}

TEST(LinkUrlTest, ReadsMavsdkUrls) {
  const LinkUrl serial = ParseLinkUrl("serial:///dev/ttyAMA0:921600");
  EXPECT_EQ(serial.scheme, LinkScheme::kSerial);
  EXPECT_EQ(serial.place, "/dev/ttyAMA0");
  EXPECT_EQ(serial.number, 921600);
  EXPECT_EQ(ParseLinkUrl("udpin://0.0.0.0:14550").number, 14550);
  EXPECT_EQ(ParseLinkUrl("tcpout://[::1]:5760").place, "::1");
  EXPECT_EQ(ParseLinkUrl("serial_flowcontrol:///dev/ttyS1:57600").scheme,
            LinkScheme::kSerialFlowControl);
}

TEST(LinkUrlTest, ReportsMalformedUrls) {
  const auto error = [](const std::string& url) { return ErrorOf([&] { ParseLinkUrl(url); }); };
  EXPECT_THAT(error("14550"), testing::HasSubstr("autopilot '14550': has no scheme"));
  EXPECT_THAT(error("mavlink://x:1"), testing::HasSubstr("unknown scheme 'mavlink'"));
  EXPECT_THAT(error("udp://x:1"), testing::HasSubstr("expected udpin or udpout"));
  EXPECT_THAT(error("udpin://0.0.0.0"), testing::HasSubstr("no port at its end"));
  EXPECT_THAT(error("udpin://[::1]"), testing::HasSubstr("no port at its end"));
  EXPECT_THAT(error("udpin://:14550"), testing::HasSubstr("no host"));
  EXPECT_THAT(error("udpin://a:99999"), testing::HasSubstr("'99999' is no port"));
  EXPECT_THAT(error("serial:///dev/ttyS0:fast"), testing::HasSubstr("'fast' is no baud rate"));
}

TEST(LinkUrlTest, SuggestsIntendedUrl) {
  const std::pair<const char*, const char*> cases[] = {
      {"/dev/ttyACM0", "serial:///dev/ttyACM0:57600"},
      {"/dev/ttyAMA0:921600", "serial:///dev/ttyAMA0:921600"},
      {"/dev/ttyUSB0,115200", "serial:///dev/ttyUSB0:115200"},
      {"/dev/serial0", "serial:///dev/serial0:57600"},
      {"ttyTHS1", "serial:///dev/ttyTHS1:57600"},
      {"serial:/dev/ttyACM0:57600", "serial:///dev/ttyACM0:57600"},
      {"com3", "serial:///dev/ttyACM0:57600"},
      {"COM12:115200", "serial:///dev/ttyACM0:115200"},
      {"192.168.1.5:5760", "tcpout://192.168.1.5:5760"},
      {"localhost:5760", "tcpout://localhost:5760"},
      {"tcp:127.0.0.1:5760", "tcpout://127.0.0.1:5760"},
      {"tcp://10.0.0.2:5762", "tcpout://10.0.0.2:5762"},
      {"tcpin:0.0.0.0:5760", "tcpin://0.0.0.0:5760"},
      {"udp:127.0.0.1:14550", "udpin://127.0.0.1:14550"},
      {"udp://:14540", "udpin://0.0.0.0:14540"},
      {"udpout:10.0.0.2:14550", "udpout://10.0.0.2:14550"},
      {":14550", "udpin://0.0.0.0:14550"},
      {"14550", "udpin://0.0.0.0:14550"},
      {"192.168.1.5:14550", "udpout://192.168.1.5:14550"},
      {"192.168.1.5", "udpout://192.168.1.5:14550"},
  };
  for (const auto& [given, meant] : cases) {
    EXPECT_THAT(ErrorOf([&url = given] { ParseLinkUrl(url); }), testing::HasSubstr(meant)) << given;
    ParseLinkUrl(meant);  // does not throw
  }
}

TEST(SilenceTest, ReportsCauseOfSilence) {
  const auto receive = [](Connection* connection) {
    for (int i = 0; i < 100; ++i) connection->Receive(milliseconds(2), [](const auto&, Time) {});
    return WhySilent(*connection);
  };
  const int port = FreeLoopbackPort();
  Connection nobody(Url("tcpout", port), {});
  EXPECT_EQ(receive(&nobody),
            Url("tcpout", port) + " refused: does the other end run, is its port right?");
  Connection in(Url("udpin", port), {});
  EXPECT_EQ(receive(&in), "nothing received on " + Url("udpin", port));
  const auto stranger = OpenTransport(ParseLinkUrl(Url("udpout", port)));
  EXPECT_TRUE(stranger->Send(std::vector<std::uint8_t>(100, 0x55)));
  EXPECT_EQ(receive(&in), "bytes on " + Url("udpin", port) + ", but no MAVLink");
  Connection other(Url("udpout", port), {});
  other.Send(mavlink::Heartbeat{18, 8, 0, 0, 4, 3});
  EXPECT_EQ(receive(&in), "MAVLink on " + Url("udpin", port) + ", but no autopilot's heartbeat");
}

TEST(SilenceTest, SuspectsWrongBaudRate) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  grantpt(master);
  unlockpt(master);
  const std::string device = ptsname(master);
  Connection connection("serial://" + device + ":57600", {});
  const std::vector<std::uint8_t> garbage(100, 0x55);
  ASSERT_EQ(write(master, garbage.data(), garbage.size()), 100);
  for (int i = 0; i < 10; ++i) connection.Receive(milliseconds(5), [](const auto&, Time) {});
  EXPECT_EQ(WhySilent(connection),
            "bytes on " + device + ", but no MAVLink: is its baud rate 57600?");
  close(master);
}

TEST(ConnectionTest, ReportsMissingDeviceOrHost) {
  EXPECT_THAT(ErrorOfUrl("serial:///dev/no_such_line:57600"),
              testing::HasSubstr("there is no /dev/no_such_line"));
  EXPECT_THAT(ErrorOfUrl("serial:///dev/null:57600"), testing::HasSubstr("is no serial line"));
  EXPECT_THAT(ErrorOfUrl("serial:///dev/null:57601"), testing::HasSubstr("57601 baud is no rate"));
  EXPECT_THAT(ErrorOfUrl("udpout://no.such.host.invalid:1"), testing::HasSubstr("is not known"));
  ConnectionOptions options;
  options.component_id = 0;
  EXPECT_THAT(ErrorOf([&] { Connection("udpin://127.0.0.1:1", options); }),
              testing::HasSubstr("component_id is 0"));
}

TEST(ConnectionTest, ReportsPortInUse) {
  const int port = FreeLoopbackPort();
  const Connection first(Url("udpin", port), {});
  EXPECT_THAT(ErrorOfUrl(Url("udpin", port)), testing::HasSubstr("is in use by another program"));
  const Connection server(Url("tcpin", port), {});
  EXPECT_THAT(ErrorOfUrl(Url("tcpin", port)), testing::HasSubstr("is in use by another program"));
}

TEST(ConnectionTest, CommunicatesOverUdp) {
  const int port = FreeLoopbackPort();
  Connection in(Url("udpin", port), {});
  EXPECT_FALSE(in.Send(mavlink::Heartbeat{}));  // nobody has sent to it yet
  EXPECT_EQ(in.counters().unsent, 1u);
  Connection out(Url("udpout", port), {});
  ExpectBothWays(&out, &in);
}

TEST(ConnectionTest, AnswersMavlinkPeersOnly) {
  const int port = FreeLoopbackPort();
  Connection in(Url("udpin", port), {});
  const auto stranger = OpenTransport(ParseLinkUrl(Url("udpout", port)));
  const std::vector<std::uint8_t> garbage(100, 0xfd);
  EXPECT_TRUE(stranger->Send(garbage));
  in.Receive(milliseconds(100), [](const mavlink::Packet&, Time) { FAIL(); });
  EXPECT_FALSE(in.is_connected());
  EXPECT_EQ(in.counters().garbage_bytes, 100u);
  Connection out(Url("udpout", port), {});
  ExpectBothWays(&out, &in);
}

TEST(ConnectionTest, FindsRestartedUdpAutopilot) {
  const int port = FreeLoopbackPort();
  Connection in(Url("udpin", port), {});
  for (int i = 0; i < 6; ++i) {
    Connection out(Url("udpout", port), {});
    EXPECT_GE(Heartbeats(&out, &in, 2), 2);
    EXPECT_GE(Heartbeats(&in, &out, 2), 2);
  }
}

TEST(ConnectionTest, CommunicatesOverTcpAndReconnects) {
  const int port = FreeLoopbackPort();
  Connection client(Url("tcpout", port), {});  // opened before there is a server
  client.Receive(milliseconds(1), [](const mavlink::Packet&, Time) {});
  EXPECT_FALSE(client.Send(mavlink::Heartbeat{}));
  for (int i = 0; i < 2; ++i) {
    Connection server(Url("tcpin", port), {});
    ExpectBothWays(&client, &server);
  }
}

TEST(ConnectionTest, ServerAcceptsNextClient) {
  const int port = FreeLoopbackPort();
  Connection server(Url("tcpin", port), {});
  for (int i = 0; i < 3; ++i) {
    Connection client(Url("tcpout", port), {});
    ExpectBothWays(&client, &server);
  }
}

TEST(ConnectionTest, DropsPacketsWhenLineIsFull) {
  const int port = FreeLoopbackPort();
  Connection server(Url("tcpin", port), {});
  Connection client(Url("tcpout", port), {});
  ExpectBothWays(&client, &server);
  mavlink::Statustext text;
  text.text.fill('x');
  for (int i = 0; i < 1'000'000 && client.counters().unsent < 1000; ++i) client.Send(text);
  EXPECT_GE(client.counters().unsent, 1000u);
  // Packets that are accepted later are complete again.
  int heard = 0;
  for (int i = 0; i < 100'000 && client.counters().unsent < 2000; ++i) {
    server.Receive(milliseconds(0), [&](const mavlink::Packet&, Time) { ++heard; });
    client.Send(text);
    if (heard > 10'000) break;
  }
  EXPECT_GT(heard, 1000);
  EXPECT_EQ(server.counters().bad_checksums, 0u);
  EXPECT_EQ(server.counters().garbage_bytes, 0u);
}

// The other end of a serial line: a pseudo-terminal. Skipped where the machine has none (/dev/pts).
class SerialLineTest : public testing::Test {
 protected:
  SerialLineTest() : far_end_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {}

  void SetUp() override {
    const int far_end = far_end_.number();
    if (far_end < 0 || grantpt(far_end) != 0 || unlockpt(far_end) != 0) {
      GTEST_SKIP() << "no pseudo-terminal: " << std::strerror(errno);
    }
    device_ = ptsname(far_end);
  }

  FileDescriptor far_end_;
  std::string device_;
};

TEST_F(SerialLineTest, Communicates) {
  Connection line("serial://" + device_ + ":57600", {});
  EXPECT_TRUE(line.Send(mavlink::Heartbeat{2, 3, 0, 0, 4, 3}));
  std::array<std::uint8_t, 300> bytes;
  const ssize_t size = read(far_end_.number(), bytes.data(), bytes.size());
  ASSERT_EQ(size, 21);
  ASSERT_EQ(write(far_end_.number(), bytes.data(), size), size);
  int heard = 0;
  line.Receive(milliseconds(500), [&](const mavlink::Packet& packet, Time) {
    EXPECT_EQ(packet.As<mavlink::Heartbeat>()->type, 2);
    ++heard;
  });
  EXPECT_EQ(heard, 1);
}

TEST_F(SerialLineTest, ReportsLineInUse) {
  const std::string url = "serial://" + device_ + ":57600";
  const Connection first(url, {});
  EXPECT_THAT(ErrorOfUrl(url), testing::HasSubstr(device_ + ": in use by another program"));
}

TEST_F(SerialLineTest, OutlivesItsDevice) {
  Connection line("serial://" + device_ + ":57600", {});
  EXPECT_TRUE(line.is_connected());
  far_end_.Close();
  const auto ignore = [](const mavlink::Packet&, Time) {};
  for (int i = 0; i < 20; ++i) {
    line.Receive(milliseconds(10), ignore);
    line.Send(mavlink::Heartbeat{});
  }
  EXPECT_FALSE(line.is_connected());
  EXPECT_GT(line.counters().unsent, 0u);
}

class SignedConnectionTest : public testing::Test {
 protected:
  SignedConnectionTest() {
    WriteKey(path_, "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f\n");
    options_.signing_key = path_;
  }
  static void WriteKey(const std::string& path, const std::string& text) {
    WriteFile(path, text);
    chmod(path.c_str(), S_IRUSR | S_IWUSR);
  }

  const TestFolder folder_;
  const std::string path_ = folder_ / "signing_key";
  ConnectionOptions options_;
};

TEST_F(SignedConnectionTest, CommunicatesWithSameKeyOnly) {
  const int port = FreeLoopbackPort();
  Connection in(Url("udpin", port), options_);
  Connection out(Url("udpout", port), options_);
  ExpectBothWays(&out, &in);
  Connection stranger(Url("udpout", port), {});
  in.Receive(milliseconds(0), [](const mavlink::Packet&, Time) {});
  stranger.Send(mavlink::Heartbeat{});
  in.Receive(milliseconds(100), [](const mavlink::Packet&, Time) { FAIL(); });
  EXPECT_EQ(in.counters().unsigned_packets, 1u);
}

TEST_F(SignedConnectionTest, RefusesAnotherKey) {
  const int port = FreeLoopbackPort();
  Connection in(Url("udpin", port), options_);
  WriteKey(path_ + "2", std::string(32, 'k'));
  ConnectionOptions other;
  other.signing_key = path_ + "2";
  Connection out(Url("udpout", port), other);
  out.Send(mavlink::Heartbeat{});
  in.Receive(milliseconds(100), [](const mavlink::Packet&, Time) { FAIL(); });
  EXPECT_EQ(in.counters().forged_packets, 1u);
}

TEST_F(SignedConnectionTest, RefusesReplayedPackets) {
  const int port = FreeLoopbackPort();
  std::vector<std::uint8_t> frame;
  Connection in(Url("udpin", port), options_,
                [&](auto bytes, Time) { frame.assign(bytes.begin(), bytes.end()); });
  Connection out(Url("udpout", port), options_);
  ASSERT_GE(Heartbeats(&out, &in, 1), 1);
  const auto thief = OpenTransport(ParseLinkUrl(Url("udpout", port)));
  EXPECT_TRUE(thief->Send(frame));
  in.Receive(milliseconds(100), [](const mavlink::Packet&, Time) { FAIL(); });
  EXPECT_EQ(in.counters().replayed_packets, 1u);
}

TEST_F(SignedConnectionTest, RemembersItsTimestamps) {
  const int port = FreeLoopbackPort();
  { const Connection first(Url("udpin", port), options_); }
  const std::uint64_t year_2100 = 268'000'000'000'000;
  WriteFile(path_ + ".timestamp", std::to_string(year_2100) + "\n");
  std::vector<std::uint8_t> frame;
  Connection in(Url("udpin", port), {},
                [&](auto bytes, Time) { frame.assign(bytes.begin(), bytes.end()); });
  {
    Connection out(Url("udpout", port), options_);
    ASSERT_GE(Heartbeats(&out, &in, 1), 1);
  }
  std::uint64_t timestamp = 0;
  std::memcpy(&timestamp, frame.data() + frame.size() - 12, 6);
  EXPECT_GT(timestamp, year_2100);
  const TimestampFile file(path_ + ".timestamp");
  EXPECT_GT(file.stored(), timestamp);
}

TEST_F(SignedConnectionTest, ReportsFaultyKeyFile) {
  const auto error = [&] { return ErrorOf([&] { mavlink::ReadSigningKey(path_); }); };
  EXPECT_EQ(error(), "no error");
  chmod(path_.c_str(), 0644);
  EXPECT_THAT(error(), testing::HasSubstr("(mode 0644), expected mode 0600: chmod 600"));
  WriteKey(path_, "too short");
  EXPECT_THAT(error(), testing::HasSubstr("has 9 bytes, expected 32 bytes or 64 hexadecimal"));
  WriteKey(path_, std::string(64, '0'));
  EXPECT_THAT(error(), testing::HasSubstr("is all zeros"));
  std::filesystem::remove(path_);
  EXPECT_THAT(error(), testing::HasSubstr(path_));
}

// A thread that has news for the line does not let it wait for the line's patience.
TEST(ConnectionTest, WakeEndsWait) {
  Connection connection("udpin://127.0.0.1:" + std::to_string(FreeLoopbackPort()), {});
  connection.Wake();
  const Time start = Now();
  connection.Receive(std::chrono::seconds(30), [](const auto&, Time) {});
  EXPECT_LT(ToSeconds(Now() - start), 15);
}

}  // namespace
}  // namespace kestrel
