// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Measures the rates of the wanted messages and decides when to request them again: another ground
// station may request a lower rate, a parameter transfer slows everything down, a restart forgets
// all.
class StreamRequests {
 public:
  struct Request {
    std::uint32_t id = 0;
    double rate_hz = 0;
    int requests = 0;            // number of earlier requests for this message
    bool is_unanswered = false;  // no message ever came: it may be an older autopilot
  };

  // Sets the wanted rate of message 'id' (Hz) from now on; 0: not wanted any more.
  void Want(std::uint32_t id, double rate_hz);
  // The same for a message that the autopilot may not have: if it does not come, it is soon
  // requested only once a minute.
  void WantIfThere(std::uint32_t id, double rate_hz);

  // A message of this id was received.
  void Count(std::uint32_t id);

  // Sets 'request' to a request that is due at 'now', one at a time; false: none is. Call it at
  // least every second. A message at less than 0.7 of its rate is requested again, every second at
  // first and every five seconds later.
  bool Next(Time now, Request* request);

  // The autopilot has forgotten all requests.
  void RequestAgain();

  // Rate over the last whole second, or over the last four messages that should have come; 1/s.
  double RateOf(std::uint32_t id) const;

 private:
  struct Stream {
    std::uint32_t id = 0;
    double rate_hz = 0;
    bool is_optional = false;
    int count = 0;
    Time counted_from{};
    bool has_come = false;
    bool begins = false;  // the first message has come, and is not taken note of yet
    double measured_hz = 0;
    int requests = 0;
    Time due{};
  };
  Stream& Get(std::uint32_t id);
  static void Begin(Time now, Stream* stream);
  static void Measure(Time now, Stream* stream);

  std::vector<Stream> streams_;
};

}  // namespace kestrel
