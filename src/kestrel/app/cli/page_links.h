// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Prints the links of a page (WebServer::urls) to standard error; on a terminal also as a QR code
// for a phone, where other devices reach the page.
void PrintLinks(const std::vector<std::string>& urls);

// Returns the QR code of a text as lines for a terminal: two rows of modules a line, white on
// black.
std::string QrLines(const std::string& text);

}  // namespace kestrel
