// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace kestrel {

// Keeps the domain, with DiscoverySettings() and then those of CYCLONEDDS_URI, as long as it lives;
// all that is opened in one process meanwhile shares it. What Cyclone logs of peers that cannot be
// reached, period after period, is not shown. Throws InputError where the settings are at fault.
std::shared_ptr<const void> OpenDdsDomain(int domain);

}  // namespace kestrel
