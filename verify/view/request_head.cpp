#include "verify/view/request_head.h"

#include <sodium/utils.h>

#include <algorithm>
#include <charconv>

namespace svdag {
namespace {

// Takes the text up to `end` from the front; all of it if `end` is not there.
std::string_view take(std::string_view* text, std::string_view end) {
  const std::string_view taken = text->substr(0, text->find(end));
  text->remove_prefix(std::min(taken.size() + end.size(), text->size()));
  return taken;
}

bool is_equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::string_view trimmed(std::string_view text) {
  const size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

// In constant time, so that the token cannot be guessed byte by byte.
bool begins_with_secret(std::string_view text, std::string_view secret) {
  return text.size() >= secret.size() &&
         sodium_memcmp(text.data(), secret.data(), secret.size()) == 0;
}

}  // namespace

bool is_this_machine(std::string_view host) {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    std::string_view port = host.substr(name.size());
    if (port.empty()) return true;
    if (port[0] != ':') continue;
    port.remove_prefix(1);
    uint16_t number = 0;
    const auto read = std::from_chars(port.data(), port.data() + port.size(), number);
    return read.ec == std::errc() && read.ptr == port.data() + port.size();
  }
  return false;
}

int admission_status(std::string_view head, std::string_view root) {
  std::string_view line = take(&head, "\r\n");
  const std::string_view method = take(&line, " "), path = take(&line, " ");
  if (!line.starts_with("HTTP/1.")) return 400;
  int hosts = 0;
  bool is_admitted = begins_with_secret(path, root);
  while (!head.empty()) {
    std::string_view value = take(&head, "\r\n");
    if (!is_equal_ignoring_case(take(&value, ":"), "Host")) continue;
    ++hosts;
    is_admitted = is_admitted && is_this_machine(trimmed(value));
  }
  if (!is_admitted || hosts != 1) return 403;
  return method == "GET" || method == "HEAD" ? 200 : 405;
}

std::string_view requested_name(std::string_view head, std::string_view root) {
  take(&head, " ");
  return take(&head, " ").substr(root.size());
}

}  // namespace svdag
