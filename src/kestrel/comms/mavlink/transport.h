// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Carries bytes to the other end of a link and back. What the other end does, or stops doing, never
// blocks and never throws: a line that breaks is opened again, less and less often. One thread
// calls Receive; Send may be called by others meanwhile.
class Transport {
 public:
  virtual ~Transport() = default;

  // Waits at most 'timeout' for bytes, and returns how many it put into 'buffer': those of one
  // datagram where the line has datagrams. 0: none came.
  virtual std::size_t Receive(Duration timeout, std::span<std::uint8_t> buffer) = 0;

  // The bytes that Receive gave last were MAVLink: whoever sent them is the other end.
  virtual void Confirm() {}

  // False when they do not fit into what the system holds for the line at this moment, or when the
  // other end is away: then nothing of them is sent.
  virtual bool Send(std::span<const std::uint8_t> frame) = 0;

  // As far as this end can know.
  virtual bool is_connected() const = 0;
  virtual bool has_datagrams() const = 0;
};

// Throws InputError with one line when the device is not there or is no serial line, when its baud
// rate is none, when another program has the device or the port, or when the host is not known. A
// server that does not answer yet is no error.
std::unique_ptr<Transport> OpenTransport(const LinkUrl& url);

}  // namespace kestrel
