// The head of an HTTP request, as far as the server decides from it whether to answer.
//
// It is read before any other code sees the request, so it accepts only the plain form that
// browsers send: one line with method, path and version, then fields, among them one Host.
#pragma once

#include <string_view>

namespace svdag {

constexpr std::string_view kEndOfHead = "\r\n\r\n";

// The status of the answer: 200 if a request may be answered, 403 without the path's prefix `root`
// (which contains the token) or for another host, 405 for other methods than GET and HEAD, 400 if
// this is not a head. `head`: up to kEndOfHead, inclusive.
// Checks the token in constant time.
int admission_status(std::string_view head, std::string_view root);

// The path after `root` of an admitted request: "tiles/1".
std::string_view requested_name(std::string_view head, std::string_view root);

// Whether a Host field names this machine; any port, because tunnels have their own.
bool is_this_machine(std::string_view host);

}  // namespace svdag
