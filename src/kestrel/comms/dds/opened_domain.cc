// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/opened_domain.h"

#include <cstdlib>
#include <dds/dds.h>
#include <map>
#include <mutex>
#include <string>

#include <fmt/format.h>

#include "kestrel/comms/dds/dds_domain.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
namespace {

// After a radio gap of less than a minute the others are still known. After a longer one they are
// found again within half a second, instead of eight.
constexpr char kOften[] =
    "<Discovery><LeaseDuration>60 s</LeaseDuration><SPDPInterval>500 ms</SPDPInterval></Discovery>";

class Domain {
 public:
  explicit Domain(int domain) {
    dds_set_log_sink([](void* /*unused*/, const dds_log_data_t* /*data*/) {}, nullptr);
    const char* const variable = std::getenv("CYCLONEDDS_URI");
    const std::string given = variable == nullptr ? "" : variable;
    std::string settings = kOften;
    for (const std::string& more : {DiscoverySettings(), given}) {
      if (!more.empty()) settings += "," + more;
    }
    entity_ = dds_create_domain(static_cast<dds_domainid_t>(domain), settings.c_str());
    if (entity_ >= 0) return;
    throw InputError(fmt::format("DDS domain {}: {} (CYCLONEDDS_URI '{}'; is there a network?)",
                                 domain, dds_strretcode(-entity_), Shown(given)));
  }
  ~Domain() { dds_delete(entity_); }
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

 private:
  dds_entity_t entity_;
};

}  // namespace

std::shared_ptr<const void> OpenDdsDomain(int domain) {
  static std::mutex mutex;
  static std::map<int, std::weak_ptr<const void>> domains;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const void> opened = domains[domain].lock();
  if (!opened) domains[domain] = opened = std::make_shared<const Domain>(domain);
  return opened;
}

}  // namespace kestrel
