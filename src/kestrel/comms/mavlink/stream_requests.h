// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "kestrel/core/base/time.h"

namespace kestrel {

// How often the messages that are wanted of an autopilot come, and when it has to be asked again:
// another ground station may ask for less, parameters on their way slow all down, a reboot forgets.
class StreamRequests {
 public:
  struct Request {
    std::uint32_t id = 0;
    double rate_hz = 0;
    int requests = 0;            // of this message before
    bool is_unanswered = false;  // nothing ever came of those before: it may be an older autopilot
  };

  // Wants message 'id' 'rate_hz' times a second from now on, or no longer (0).
  void Want(std::uint32_t id, double rate_hz);
  // The same for a message that the autopilot may not have: when it does not come it is soon asked
  // for once a minute only.
  void WantIfThere(std::uint32_t id, double rate_hz);

  // Such a message was received.
  void Count(std::uint32_t id);

  // A request that is due at 'now', one at a time; false: none is. To be called every second at
  // least. A message that comes with less than 0.7 of its rate is asked for again, each second at
  // first and every five seconds later.
  bool Next(Time now, Request* request);

  // The autopilot forgot all that it was asked.
  void AskAgain();

  // Of the last whole second, or of the last four messages that should have come; 1/s.
  double RateOf(std::uint32_t id) const;

 private:
  struct Stream {
    std::uint32_t id = 0;
    double rate_hz = 0;
    bool is_optional = false;
    int count = 0;
    Time counted_from{};
    bool has_come = false;
    double measured_hz = 0;
    int requests = 0;
    Time due{};
  };
  Stream& Get(std::uint32_t id);
  static void Measure(Time now, Stream* stream);

  std::vector<Stream> streams_;
};

}  // namespace kestrel
