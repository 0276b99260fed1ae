// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "kestrel/comms/mavlink/bell.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Carries bytes to the other end of a link and back. Whatever the other end does, it never blocks
// and never throws: a broken line is opened again, at growing intervals. One thread calls Receive;
// other threads may call Send meanwhile.
class Transport {
 public:
  virtual ~Transport() = default;

  // Waits at most 'timeout' for bytes or for Wake, and returns the number written to 'buffer': one
  // datagram where the line has datagrams. 0: none came.
  virtual std::size_t Receive(Duration timeout, std::span<std::uint8_t> buffer) = 0;

  // Ends the present wait of Receive, or else the next one. Any thread.
  void Wake() { bell_.Ring(); }

  // The bytes of the last Receive were MAVLink: their sender is the other end.
  virtual void Confirm() {}

  // False when the frame does not fit into the system's buffer at this moment, or when the other
  // end is away: nothing of it is then sent.
  virtual bool Send(std::span<const std::uint8_t> frame) = 0;

  // True when connected, as far as this end can know.
  virtual bool is_connected() const = 0;
  virtual bool has_datagrams() const = 0;
  // Why the line could not be opened when that was last tried (errno); 0: it is open, or nobody has
  // tried. Any thread.
  virtual int open_error() const { return 0; }

  // The files on which Receive waits, for a thread that also waits for others; -1: none at this
  // moment. Called by the receiving thread.
  virtual std::array<int, 2> files() const = 0;

 protected:
  Bell& bell() { return bell_; }

 private:
  Bell bell_;
};

// Throws InputError with one line when the device does not exist or is not a serial line, when its
// baud rate is not valid, when another program has the device or the port, or when the host is not
// known. A server that does not answer yet is not an error.
std::unique_ptr<Transport> OpenTransport(const LinkUrl& url);

}  // namespace kestrel
