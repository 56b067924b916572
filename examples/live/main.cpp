// SPDX-License-Identifier: MIT
//
// ellipse-live: runs the tracker on a machine without a screen, controlled from a browser. See
// examples/live/README.md.
#include <glib-unix.h>
#include <gst/gst.h>

#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "examples/live/http/api.hpp"
#include "examples/live/http/http_server.hpp"
#include "examples/live/http/security.hpp"
#include "examples/live/options.hpp"
#include "examples/live/pipeline/presets.hpp"
#include "examples/live/session.hpp"

namespace {

using MainLoop = std::unique_ptr<GMainLoop, decltype(&g_main_loop_unref)>;

gboolean on_signal(gpointer loop) {
  g_main_loop_quit(static_cast<GMainLoop*>(loop));
  return G_SOURCE_CONTINUE;
}

// Ends the main loop on SIGINT, SIGTERM and SIGHUP. Under nohup, SIGHUP stays ignored.
void end_on_signals(GMainLoop* loop) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    sigaction(number, nullptr, &now);
    if (number == SIGHUP && now.sa_handler == SIG_IGN) continue;
    g_unix_signal_add(number, on_signal, loop);
  }
}

std::string token_for(const live::Options& options) {
  const bool is_open = !live::is_loopback_address(options.bind);
  return is_open && options.token.empty() ? live::make_token() : options.token;
}

void print_addresses(const live::Options& options,
                     const live::HttpServer& server,
                     const live::Session& session) {
  const bool is_ipv6 = options.bind.find(':') != std::string::npos;
  const std::string host = is_ipv6 ? "[" + options.bind + "]" : options.bind;
  std::cout << "ellipse-live: http://" << host << ":" << server.port() << "/"
            << (options.token.empty() ? "" : "?token=" + options.token) << std::endl;
  if (!session.rtsp()) return;
  std::cout << "ellipse-live: rtsp://"
            << (options.token.empty() ? "" : "ellipse:" + options.token + "@") << host << ":"
            << session.rtsp()->port() << "/live" << std::endl;
}

int run(live::Options options) {
  options.token = token_for(options);
  const MainLoop loop(g_main_loop_new(nullptr, FALSE), g_main_loop_unref);
  // Outlives the session, whose streams belong to the server's connections.
  live::HttpServer server({.address = options.bind, .port = options.port, .token = options.token});
  bool has_failed = false;
  live::Session session(options, [&] {
    // A client that can change the source sees the error and can choose another one.
    if (session.pipeline().frames() > 0 || options.allows_source_change) return;
    has_failed = true;
    g_main_loop_quit(loop.get());
  });
  if (!options.preset.empty()) {
    live::load_preset(session.pipeline().tracker(), options.preset);
  }
  live::add_api(server, session, options);
  session.open(options.source, options.fps);
  print_addresses(options, server, session);
  end_on_signals(loop.get());
  if (!has_failed) g_main_loop_run(loop.get());
  return has_failed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const live::Options options = live::parse_options(argc, argv);
  gst_init(nullptr, nullptr);
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "ellipse-live: " << error.what() << '\n';
    return 1;
  }
}
