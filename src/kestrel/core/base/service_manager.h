// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// The service manager that has started this program, if one has that wants to know how it is:
// systemd, by sd_notify(3). Its protocol is one datagram to the socket that NOTIFY_SOCKET names.
class ServiceManager {
 public:
  ServiceManager();

  // Sends a state, as "READY=1" or "WATCHDOG=1"; does not wait. False: nobody has taken it.
  bool Notify(std::string_view state) const;

 private:
  std::string socket_;  // empty: there is none
};

}  // namespace kestrel
