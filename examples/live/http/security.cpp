// SPDX-License-Identifier: MIT
#include "examples/live/http/security.hpp"

#include <gio/gio.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "examples/live/ref.hpp"

namespace live {

RateLimiter::RateLimiter(double per_second, double burst, Clock clock)
    : per_second_(per_second),
      burst_(burst),
      left_(burst),
      clock_(clock != nullptr ? clock : g_get_monotonic_time),
      last_us_(clock_()) {}

bool RateLimiter::take() {
  const std::int64_t now_us = clock_();
  left_ = std::min(burst_, left_ + 1e-6 * static_cast<double>(now_us - last_us_) * per_second_);
  last_us_ = now_us;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

bool is_foreign(const Origin& origin) {
  const bool is_cross_site =
      origin.sec_fetch_site == "cross-site" || origin.sec_fetch_site == "same-site";
  if (is_cross_site) return true;
  return !origin.origin.empty() && origin.origin != "http://" + origin.host;
}

bool is_loopback_host(const std::string& host) {
  const std::size_t port = host.rfind(':');
  const bool has_port = port != std::string::npos && host.find(']', port) == std::string::npos;
  std::string name = has_port ? host.substr(0, port) : host;
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  return name == "localhost" || is_loopback_address(name);
}

bool is_loopback_address(const std::string& address) {
  const Ref<GInetAddress> parsed(g_inet_address_new_from_string(address.c_str()));
  return parsed && g_inet_address_get_is_loopback(parsed.get());
}

std::string make_token() {
  std::array<unsigned char, 16> random;
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    throw std::runtime_error("cannot read random numbers from the system");
  }
  std::string token;
  for (const unsigned char byte : random) {
    std::array<char, 3> digits;
    std::snprintf(digits.data(), digits.size(), "%02x", byte);
    token += digits.data();
  }
  return token;
}

bool is_same_secret(std::string_view given, std::string_view secret) {
  // Compares all bytes, so that the time does not depend on the position of the first difference.
  unsigned difference = given.size() == secret.size() ? 0U : 1U;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    const char other = i < given.size() ? given[i] : '\0';
    difference |= static_cast<unsigned char>(other) ^ static_cast<unsigned char>(secret[i]);
  }
  return difference == 0;
}

}  // namespace live
