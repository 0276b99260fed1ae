// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/thread_setup.h"

#include <cerrno>
#include <pthread.h>
#include <sched.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

namespace kestrel {
namespace {

int CpuCount() { return static_cast<int>(sysconf(_SC_NPROCESSORS_CONF)); }

std::string InWords(int error) { return std::generic_category().message(error); }

std::string Pin(const std::string& name, int cpu) {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<std::size_t>(cpu), &cpus);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof(cpus), &cpus);
  if (error == 0) return "";
  return fmt::format("thread {}: cannot be kept on processor {}: {}", name, cpu, InWords(error));
}

std::string Prioritise(const std::string& name, int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  if (error == 0) return "";
  if (error != EPERM) {
    return fmt::format("thread {}: no priority {}: {}", name, priority, InWords(error));
  }
  return fmt::format(
      "thread {}: priority {} is not permitted, it runs as a usual one: give the program the right "
      "(setcap cap_sys_nice=ep, or LimitRTPRIO= of its systemd service)",
      name, priority);
}

}  // namespace

std::vector<std::string> ThreadOptions::Validate() const {
  if (cpu < CpuCount()) return {};
  return {fmt::format("cpu is {}, expected -1 or 0 to {}, which this computer has", cpu,
                      CpuCount() - 1)};
}

std::string SetUpThisThread(const std::string& name, const ThreadOptions& options) {
  constexpr std::size_t kMaxName = 15;
  pthread_setname_np(pthread_self(), name.substr(0, kMaxName).c_str());
  std::string refused;
  if (options.cpu >= 0) refused = Pin(name, options.cpu);
  if (options.priority == 0) return refused;
  const std::string priority_refused = Prioritise(name, options.priority);
  if (refused.empty() || priority_refused.empty()) return refused + priority_refused;
  return refused + "; " + priority_refused;
}

}  // namespace kestrel
