// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/serial_transport.h"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <optional>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/device_fault.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

std::optional<speed_t> SpeedOf(int baud) {
  constexpr std::array<std::pair<int, speed_t>, 15> kSpeeds = {{{9600, B9600},
                                                                {19200, B19200},
                                                                {38400, B38400},
                                                                {57600, B57600},
                                                                {115200, B115200},
                                                                {230400, B230400},
                                                                {460800, B460800},
                                                                {500000, B500000},
                                                                {576000, B576000},
                                                                {921600, B921600},
                                                                {1000000, B1000000},
                                                                {1500000, B1500000},
                                                                {2000000, B2000000},
                                                                {3000000, B3000000},
                                                                {4000000, B4000000}}};
  for (const auto& [known, speed] : kSpeeds) {
    if (known == baud) return speed;
  }
  return std::nullopt;
}

bool Configure(const FileDescriptor& file, speed_t speed, bool has_flow_control) {
  termios settings{};
  if (tcgetattr(file.number(), &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  if (has_flow_control) settings.c_cflag |= CRTSCTS;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  cfsetispeed(&settings, speed);
  cfsetospeed(&settings, speed);
  return tcsetattr(file.number(), TCSANOW, &settings) == 0;
}

// Returns a non-blocking file of the device that no other program has, or an error in errno.
FileDescriptor OpenDevice(const std::string& path) {
  FileDescriptor file(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (file.is_open() && flock(file.number(), LOCK_EX | LOCK_NB) != 0) file.Close();
  if (file.is_open()) ioctl(file.number(), TIOCEXCL);
  return file;
}

}  // namespace

SerialTransport::SerialTransport(const LinkUrl& url) : url_(url) {
  const auto speed = SpeedOf(url.number);
  if (!speed) {
    throw InputError(
        fmt::format("autopilot '{}': {} baud is no rate of a serial line, expected "
                    "e.g. 57600, 115200 or 921600",
                    url.text, url.number));
  }
  FileDescriptor file = OpenDevice(url.place);
  const int error = errno;
  if (!file.is_open()) {
    throw InputError(fmt::format("autopilot '{}': {}", url.text, DeviceFault(url.place, error)));
  }
  if (!Configure(file, *speed, url.scheme == LinkScheme::kSerialFlowControl)) {
    throw InputError(fmt::format("autopilot '{}': {} is no serial line", url.text, url.place));
  }
  Use({std::move(file), false});
}

StreamTransport::Line SerialTransport::Open() {
  FileDescriptor file = OpenDevice(url_.place);
  if (!file.is_open() ||
      !Configure(file, *SpeedOf(url_.number), url_.scheme == LinkScheme::kSerialFlowControl)) {
    return {};
  }
  return {std::move(file), false};
}

ssize_t SerialTransport::Write(int file, std::span<const std::uint8_t> bytes) {
  return write(file, bytes.data(), bytes.size());
}

}  // namespace kestrel
