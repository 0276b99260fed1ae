// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/file.h>
#include <unistd.h>

namespace kestrel {

// Returns a domain (below 100), on this computer alone, for this process and those that it starts.
// A file that is locked as long as they run keeps it from tests that run at the same time.
inline int TestDomain() {
  constexpr int kDomains = 100;
  static const int kDomain = [] {
    for (int domain = getpid() % kDomains;; domain = (domain + 1) % kDomains) {
      const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                         ("kestrel_test_domain_" + std::to_string(domain));
      const int lock = open(file.c_str(), O_RDWR | O_CREAT, 0666);
      if (lock < 0 || flock(lock, LOCK_EX | LOCK_NB) == 0) return domain;
      close(lock);
    }
  }();
  setenv("CYCLONEDDS_URI",
         "<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface "
         "name=\"lo\"/></Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>",
         1);
  return kDomain;
}

}  // namespace kestrel
