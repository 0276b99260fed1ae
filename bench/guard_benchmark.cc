// SPDX-License-Identifier: BSD-3-Clause
// Time of a frame through the guard, there and back, beside the same way without it. The
// other end of the line answers every datagram at once. With as many bytes as 921600 baud carry in
// the background, too.
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/comms/mavlink/transport.h"
#include "kestrel/core/base/time.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kLargest = 65536;

// Answers every datagram with itself.
class Echo {
 public:
  explicit Echo(const std::string& url)
      : line_(OpenTransport(ParseLinkUrl(url))), thread_([this] { Run(); }) {}
  ~Echo() {
    is_over_ = true;
    thread_.join();
  }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;

 private:
  void Run() {
    std::vector<std::uint8_t> buffer(kLargest);
    while (!is_over_) {
      const std::size_t size = line_->Receive(milliseconds(20), buffer);
      if (size == 0) continue;
      line_->Confirm();
      line_->Send(std::span(buffer).first(size));
    }
  }

  std::unique_ptr<Transport> line_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

// Sends 'frames' frames and waits for their answers, or for 100 ms.
std::size_t Exchange(Transport* line, int frames, std::span<std::uint8_t> buffer) {
  mavlink::PacketWriter writer(1, 191);
  std::size_t sent = 0;
  for (int i = 0; i < frames; ++i) {
    const auto frame = writer.Write(mavlink::SetPositionTargetLocalNed{.vx = 1.0f});
    sent += line->Send(frame) ? frame.size() : 0;
  }
  std::size_t received = 0;
  for (const Time end = Now() + milliseconds(100); received < sent && Now() < end;) {
    const std::size_t size = line->Receive(milliseconds(100), buffer);
    received += size;
  }
  return received;
}

// The argument: frames at once. 18 are 1.1 kB, what 921600 baud carry in 12 ms.
template <class MakeLine>
void RoundTrip(benchmark::State& state, const MakeLine& make_line) {
  const int port = FreeLoopbackPort();
  const Echo echo(fmt::format("udpin://127.0.0.1:{}", port));
  const std::unique_ptr<Transport> line = make_line(fmt::format("udpout://127.0.0.1:{}", port));
  std::vector<std::uint8_t> buffer(kLargest);
  double worst_s = 0;
  std::size_t bytes = 0;
  for (auto _ : state) {
    const Time begin = Now();
    bytes += Exchange(line.get(), static_cast<int>(state.range(0)), buffer);
    worst_s = std::max(worst_s, ToSeconds(Now() - begin));
  }
  state.counters["worst_ms"] = 1e3 * worst_s;
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

void Direct(benchmark::State& state) {
  RoundTrip(state, [](const std::string& url) { return OpenTransport(ParseLinkUrl(url)); });
}
BENCHMARK(Direct)->Arg(1)->Arg(18)->UseRealTime()->Unit(benchmark::kMicrosecond);

void ThroughGuard(benchmark::State& state) {
  RoundTrip(state, [](const std::string& url) {
    return std::make_unique<GuardLink>(url, GuardOptions{.program = KESTREL_GUARD}, "");
  });
}
BENCHMARK(ThroughGuard)->Arg(1)->Arg(18)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kestrel
