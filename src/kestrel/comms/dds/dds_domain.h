// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace kestrel
