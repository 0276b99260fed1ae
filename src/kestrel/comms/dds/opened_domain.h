// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace kestrel {

// Opens the domain with DiscoverySettings() and then those of CYCLONEDDS_URI, and keeps it as long
// as the result lives; everything opened in the process meanwhile shares it. Cyclone's repeated log
// lines about unreachable peers are not shown. Throws InputError where the settings are wrong.
std::shared_ptr<const void> OpenDdsDomain(int domain);

}  // namespace kestrel
