// Requests that the viewer's server admits: with its token, for this machine, to read.
#include "verify/view/request_head.h"

#include <gtest/gtest.h>

#include <string>

namespace svdag {
namespace {

constexpr const char* kRoot = "/token/";

std::string head_of(const std::string& line, const std::string& fields) {
  return line + "\r\n" + fields + "\r\n\r\n";
}

int status_of_host(const std::string& host) {
  return admission_status(head_of("GET /token/ HTTP/1.1", "Host: " + host), kRoot);
}

TEST(RequestHead, NamesOfThisMachineAreAdmitted) {
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:1", "localhost", "localhost:65535", "[::1]", "[::1]:80"})
    EXPECT_EQ(status_of_host(host), 200) << host;
}

TEST(RequestHead, OtherHostsAreRefused) {
  for (const char* host : {"", "evil.com", "127.0.0.1:80.evil.com", "127.0.0.1.evil.com",
                           "127.0.0.1:", "127.0.0.1:-1", "127.0.0.1:65536", "127.0.0.1:80:80",
                           "127.0.0.1 evil.com", "localhost.", "[::1]80", "x127.0.0.1"})
    EXPECT_EQ(status_of_host(host), 403) << host;
}

TEST(RequestHead, ExactlyOneHostIsNeeded) {
  const std::string line = "GET /token/ HTTP/1.1";
  EXPECT_EQ(admission_status(head_of(line, "Accept: */*"), kRoot), 403);
  EXPECT_EQ(admission_status(head_of(line, "host: localhost\r\nHOST: localhost"), kRoot), 403);
  EXPECT_EQ(admission_status(head_of(line, "hOST:localhost"), kRoot), 200);
}

TEST(RequestHead, OnlyThePathWithTheTokenIsAdmitted) {
  for (const char* path :
       {"/", "/token", "/Token/", "/tokem/", "//token/", "http://localhost/token/", ""})
    EXPECT_EQ(admission_status(head_of("GET " + std::string(path) + " HTTP/1.1", "Host: localhost"),
                               kRoot),
              403)
        << path;
  EXPECT_EQ(requested_name(head_of("GET /token/tiles/1 HTTP/1.1", "Host: localhost"), kRoot),
            "tiles/1");
}

TEST(RequestHead, OnlyReadingIsAdmitted) {
  EXPECT_EQ(admission_status(head_of("HEAD /token/ HTTP/1.1", "Host: localhost"), kRoot), 200);
  EXPECT_EQ(admission_status(head_of("POST /token/ HTTP/1.1", "Host: localhost"), kRoot), 405);
  EXPECT_EQ(admission_status(head_of("POST / HTTP/1.1", "Host: localhost"), kRoot), 403);
  EXPECT_EQ(admission_status(head_of("GET /token/", "Host: localhost"), kRoot), 400);
  EXPECT_EQ(admission_status("\r\n\r\n", kRoot), 400);
}

}  // namespace
}  // namespace svdag
