// SPDX-License-Identifier: MIT
#include "examples/live/http/security.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/raw_client.hpp"

namespace {

using support::Answer;
using support::Client;
using support::LiveProgram;
using support::SocketClient;

TEST(LiveSecurity, RecognizesLoopbackAddressesAndHosts) {
  EXPECT_TRUE(live::is_loopback_address("127.0.0.1"));
  EXPECT_TRUE(live::is_loopback_address("::1"));
  EXPECT_FALSE(live::is_loopback_address("0.0.0.0"));
  EXPECT_FALSE(live::is_loopback_address("localhost.evil.example"));
  EXPECT_TRUE(live::is_loopback_host("localhost:8080"));
  EXPECT_TRUE(live::is_loopback_host("[::1]:8080"));
  EXPECT_TRUE(live::is_loopback_host("127.0.0.1"));
  EXPECT_FALSE(live::is_loopback_host("rebound.example:8080"));
  EXPECT_FALSE(live::is_loopback_host(""));
}

TEST(LiveSecurity, TokensAreRandomAndComparedCompletely) {
  const std::string token = live::make_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, live::make_token());
  EXPECT_TRUE(live::is_same_secret(token, token));
  EXPECT_FALSE(live::is_same_secret(token.substr(1), token));
  EXPECT_FALSE(live::is_same_secret(token + "0", token));
  EXPECT_FALSE(live::is_same_secret("", token));
}

std::int64_t rate_now_us = 0;

TEST(LiveSecurity, RateLimiterRefillsWithTime) {
  rate_now_us = 5'000'000;
  live::RateLimiter allowance(100.0, 300.0, [] { return rate_now_us; });
  const auto taken = [&] {
    int count = 0;
    while (allowance.take()) ++count;
    return count;
  };
  EXPECT_EQ(taken(), 300);
  rate_now_us += 9'000;
  EXPECT_EQ(taken(), 0);
  rate_now_us += 1'001;
  EXPECT_EQ(taken(), 1);
  rate_now_us += 500'000;
  EXPECT_NEAR(taken(), 50, 1);
  rate_now_us += 60'000'000;  // not above the bucket's capacity
  EXPECT_EQ(taken(), 300);
}

TEST(LiveSecurity, RejectsRequestsFromOtherSites) {
  const LiveProgram program({});
  const Client client(program.url());
  const std::string own = program.url().substr(0, program.url().size() - 1);
  const auto put = [&](const Client::Headers& headers) {
    return client.ask("PUT", "api/properties", R"({"max-axis":600})", headers).status;
  };
  EXPECT_EQ(put({{"Origin", own}}), 200U);
  EXPECT_EQ(put({{"Origin", "http://evil.example"}}), 403U);
  EXPECT_EQ(put({{"Origin", "null"}}), 403U);
  EXPECT_EQ(put({{"Sec-Fetch-Site", "cross-site"}}), 403U);
  EXPECT_EQ(client.ask("GET", "video.mjpeg", "", {{"Sec-Fetch-Site", "cross-site"}}).status, 403U);
  EXPECT_EQ(client.ask("GET", "api/target", "", {{"Host", "rebound.example"}}).status, 403U);
  EXPECT_TRUE(SocketClient(program.url(), "ws/meta", own).is_open());
  EXPECT_FALSE(SocketClient(program.url(), "ws/meta", "http://evil.example").is_open());
  EXPECT_FALSE(SocketClient(program.url(), "ws/video", "http://evil.example").is_open());
}

TEST(LiveSecurity, RequiresTheTokenEverywhere) {
  LiveProgram program({"--token", "sesame"});
  ASSERT_TRUE(program.url().ends_with("/?token=sesame"));
  const std::string url = program.url().substr(0, program.url().find('?'));
  const Client client(url);
  for (const char* path : {"", "api/target", "api/events", "video.mjpeg", "metrics", "nothing"}) {
    EXPECT_EQ(client.get(path).status, 401U) << path;
  }
  EXPECT_FALSE(SocketClient(url, "ws/video").is_open());
  EXPECT_FALSE(SocketClient(url, "ws/meta", "", "sesam").is_open());
  EXPECT_TRUE(SocketClient(url, "ws/meta", "", "sesame").is_open());
  const auto with = [&](const std::string& name, const std::string& value) {
    return client.ask("GET", "api/stats", "", {{name, value}}).status;
  };
  EXPECT_EQ(with("Authorization", "Bearer sesame"), 200U);
  EXPECT_EQ(with("Authorization", "bearer sesame"), 200U);
  EXPECT_EQ(with("Authorization", "BEARER sesame"), 200U);
  EXPECT_EQ(with("Authorization", "Bearer SESAME"), 401U);
  EXPECT_EQ(with("Authorization", "Bearer sesame2"), 401U);
  EXPECT_EQ(with("Cookie", "a=b; ellipse_token=sesame; c=d"), 200U);
  EXPECT_EQ(with("Cookie", "not_ellipse_token=sesame"), 401U);
  const Answer link = client.get("?token=sesame");
  EXPECT_EQ(link.status, 303U);
  EXPECT_NE(link.headers.at("Set-Cookie").find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(client.get("?token=sesam").status, 401U);
}

TEST(LiveSecurity, RejectsTokensThatNeedEscapingInLinks) {
  for (const char* token : {"open sesame", "a;b", "a&b", "a%41", "sésame", ""}) {
    LiveProgram program({"--token", token}, false);
    EXPECT_NE(program.line_with("--token"), "") << token;
    EXPECT_NE(program.wait(), 0) << token;
  }
  const LiveProgram program({"--token", "Az09._~-"});
  EXPECT_TRUE(program.url().ends_with("/?token=Az09._~-"));
}

struct Door {
  std::string url;  // without the token
  std::string token;
};

// Address and token of a program, from its output.
Door door_of(const LiveProgram& program) {
  const std::string& printed = program.url();
  const std::size_t end = printed.find("?token=");
  if (end == std::string::npos) return {printed, ""};
  return {printed.substr(0, end), printed.substr(end + 7)};
}

// The program made a token and rejects everything without it.
void expect_locked(const LiveProgram& program, const LiveProgram& other) {
  const auto [url, token] = door_of(program);
  ASSERT_EQ(token.size(), 32U) << program.url();
  const std::string wrong = door_of(other).token;
  EXPECT_NE(wrong, token);
  const Client client(url);
  const auto put = [&](const Client::Headers& headers) {
    return client.ask("PUT", "api/properties", R"({"max-axis":600})", headers).status;
  };
  EXPECT_EQ(client.get("").status, 401U);
  EXPECT_EQ(client.get("?token=" + wrong).status, 401U);
  EXPECT_EQ(put({}), 401U);
  EXPECT_EQ(put({{"Authorization", "Bearer " + wrong}}), 401U);
  EXPECT_EQ(put({{"Cookie", "ellipse_token=" + wrong}}), 401U);
  EXPECT_EQ(put({{"Authorization", "Bearer " + token}}), 200U);
  EXPECT_EQ(put({{"Cookie", "ellipse_token=" + token}}), 200U);
  EXPECT_FALSE(SocketClient(url, "ws/meta").is_open());
  EXPECT_FALSE(SocketClient(url, "ws/video", "", wrong).is_open());
  EXPECT_TRUE(SocketClient(url, "ws/video", "", token).is_open());
  const Answer link = client.get("?token=" + token);
  EXPECT_EQ(link.status, 303U);
  EXPECT_EQ(link.headers.at("Set-Cookie").find("ellipse_token=" + token + ";"), 0U);
}

TEST(LiveSecurity, RequiresAGeneratedTokenWhenOpenToAllNetworks) {
  const LiveProgram program({"--bind", "0.0.0.0"});
  const LiveProgram other({"--bind", "0.0.0.0"});
  expect_locked(program, other);
}

TEST(LiveSecurity, RequiresAGeneratedTokenWhenOpenToOneNetwork) {
  const std::string address = support::network_address();
  if (address.empty()) GTEST_SKIP() << "this machine is in no network";
  const LiveProgram program({"--bind", address});
  const LiveProgram other({"--bind", address});
  expect_locked(program, other);
}

TEST(LiveSecurity, ListensOnTheLoopbackByDefault) {
  const std::string address = support::network_address();
  if (address.empty()) GTEST_SKIP() << "this machine is in no network";
  const LiveProgram program({});
  const auto from = [&](const std::string& host) {
    return Client("http://" + host + ":" + std::to_string(program.port()) + "/").get("").status;
  };
  EXPECT_EQ(from("127.0.0.1"), 200U);
  EXPECT_EQ(from(address), static_cast<guint>(SOUP_STATUS_NONE));
}

// A browser sends its cookie no matter which site's page makes the request.
TEST(LiveSecurity, RejectsRequestsFromOtherSitesDespiteTheToken) {
  const LiveProgram program({"--bind", "0.0.0.0"});
  const auto [url, token] = door_of(program);
  const Client client(url);
  const auto put = [&, cookie = "ellipse_token=" + token](const char* name,
                                                          const std::string& value) {
    const Client::Headers headers{{"Cookie", cookie}, {name, value}};
    return client.ask("PUT", "api/properties", R"({"max-axis":600})", headers).status;
  };
  const std::string own = url.substr(0, url.size() - 1);
  EXPECT_EQ(put("Origin", own), 200U);
  EXPECT_EQ(put("Origin", "http://evil.example"), 403U);
  EXPECT_EQ(put("Origin", "null"), 403U);
  EXPECT_EQ(put("Sec-Fetch-Site", "cross-site"), 403U);
  EXPECT_TRUE(SocketClient(url, "ws/meta", own, token).is_open());
  EXPECT_FALSE(SocketClient(url, "ws/meta", "http://evil.example", token).is_open());
  EXPECT_FALSE(SocketClient(url, "ws/video", "http://evil.example", token).is_open());
}

}  // namespace
