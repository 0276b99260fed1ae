// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace kestrel {

// The domain that is told, or else that of ROS_DOMAIN_ID, or else 0. Throws InputError when that is
// no domain (0 to 232).
int DdsDomain(const std::optional<int>& told);

// Settings of Cyclone DDS that make it look for others where ROS 2 would, by its variables:
// ROS_AUTOMATIC_DISCOVERY_RANGE (SUBNET, LOCALHOST, OFF, SYSTEM_DEFAULT), ROS_LOCALHOST_ONLY (1,
// as LOCALHOST; goes first) and ROS_STATIC_PEERS (addresses, with semicolons between them); empty
// where they say nothing. Throws InputError for other values.
std::string DiscoverySettings();

// Keeps the domain, with these settings and then those of CYCLONEDDS_URI, as long as it lives; all
// that is opened in one process meanwhile shares it. What Cyclone logs of peers that cannot be
// reached, period after period, is not shown. Throws InputError where the settings are at fault.
std::shared_ptr<const void> OpenDdsDomain(int domain);

}  // namespace kestrel
