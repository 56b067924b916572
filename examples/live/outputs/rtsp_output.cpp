// SPDX-License-Identifier: MIT
#include "examples/live/outputs/rtsp_output.hpp"

#include <mutex>
#include <stdexcept>
#include <vector>

#include "examples/live/outputs/frame_inlet.hpp"
#include "examples/live/outputs/h264.hpp"

namespace live {
namespace {

constexpr int kRtspQueue = 2;  // frames
constexpr guint kMaxSessions = 16;
constexpr guint kSessionTickSeconds = 2;
constexpr char kInlet[] = "frames";
constexpr char kUser[] = "ellipse";
constexpr char kRole[] = "viewer";

Ref<GstElement> inlet_of(GstRTSPMedia* media) {
  const Ref<GstElement> bin(gst_rtsp_media_get_element(media));
  return Ref<GstElement>(gst_bin_get_by_name(GST_BIN(bin.get()), kInlet));
}

}  // namespace

// The appsrc elements of all prepared media. Thread-safe.
struct RtspOutput::Inlets {
  std::mutex mutex;
  std::vector<Ref<GstElement>> inlets;
  FramePtr newest;

  // Connects a signal whose handler shares ownership of the Inlets.
  static void connect(gpointer object,
                      const char* signal,
                      GCallback callback,
                      const std::shared_ptr<Inlets>& inlets) {
    g_signal_connect_data(
        object,
        signal,
        callback,
        new std::shared_ptr<Inlets>(inlets),
        [](gpointer data, GClosure*) { delete static_cast<std::shared_ptr<Inlets>*>(data); },
        GConnectFlags{});
  }

  static void on_configure(GstRTSPMediaFactory* /*factory*/, GstRTSPMedia* media, gpointer data) {
    const auto& self = *static_cast<std::shared_ptr<Inlets>*>(data);
    connect(media, "unprepared", G_CALLBACK(on_unprepared), self);
    Ref<GstElement> inlet = inlet_of(media);
    const std::lock_guard lock(self->mutex);
    // Provides the frame to preroll for a client that connects while a file is paused.
    if (self->newest) push_frame(GST_APP_SRC(inlet.get()), *self->newest);
    self->inlets.push_back(std::move(inlet));
  }

  static void on_unprepared(GstRTSPMedia* media, gpointer data) {
    const auto& self = *static_cast<std::shared_ptr<Inlets>*>(data);
    const Ref<GstElement> gone = inlet_of(media);
    const std::lock_guard lock(self->mutex);
    std::erase_if(self->inlets, [&](const auto& inlet) { return inlet.get() == gone.get(); });
  }
};

RtspOutput::RtspOutput(const Settings& settings)
    : inlets_(std::make_shared<Inlets>()), server_(gst_rtsp_server_new()) {
  gst_rtsp_server_set_address(server_.get(), settings.address.c_str());
  gst_rtsp_server_set_service(server_.get(), std::to_string(settings.port).c_str());
  GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
  gst_rtsp_media_factory_set_launch(
      factory,
      ("( " + frame_inlet(kInlet, kRtspQueue) +
       " ! videoconvert ! ellipseoverlay overlay=ellipse+axes+centre+label ! " + h264_encoder() +
       " ! rtph264pay name=pay0 pt=96 config-interval=1 )")
          .c_str());
  gst_rtsp_media_factory_set_shared(factory, TRUE);
  Inlets::connect(factory, "media-configure", G_CALLBACK(Inlets::on_configure), inlets_);
  if (!settings.token.empty()) require_token(settings.token, factory);
  const Ref<GstRTSPMountPoints> mounts(gst_rtsp_server_get_mount_points(server_.get()));
  gst_rtsp_mount_points_add_factory(mounts.get(), "/live", factory);  // transfers ownership
  const Ref<GstRTSPSessionPool> pool(gst_rtsp_server_get_session_pool(server_.get()));
  gst_rtsp_session_pool_set_max_sessions(pool.get(), kMaxSessions);
  try {
    proxy_.emplace(server_.get());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("cannot serve RTSP on " + settings.address + ":" +
                             std::to_string(settings.port) + ": " + error.what());
  }
  tick_ = g_timeout_add_seconds(kSessionTickSeconds, on_tick, this);
}

RtspOutput::~RtspOutput() {
  g_source_remove(tick_);
}

void RtspOutput::require_token(const std::string& token, GstRTSPMediaFactory* factory) {
  gst_rtsp_media_factory_add_role(factory,
                                  kRole,
                                  GST_RTSP_PERM_MEDIA_FACTORY_ACCESS,
                                  G_TYPE_BOOLEAN,
                                  TRUE,
                                  GST_RTSP_PERM_MEDIA_FACTORY_CONSTRUCT,
                                  G_TYPE_BOOLEAN,
                                  TRUE,
                                  nullptr);
  const Ref<GstRTSPAuth> auth(gst_rtsp_auth_new());
  GstRTSPToken* role =
      gst_rtsp_token_new(GST_RTSP_TOKEN_MEDIA_FACTORY_ROLE, G_TYPE_STRING, kRole, nullptr);
  const Ref<gchar> basic(gst_rtsp_auth_make_basic(kUser, token.c_str()));
  gst_rtsp_auth_add_basic(auth.get(), basic.get(), role);
  gst_rtsp_token_unref(role);
  gst_rtsp_server_set_auth(server_.get(), auth.get());
}

void RtspOutput::put(const FramePtr& frame) {
  const std::lock_guard lock(inlets_->mutex);
  inlets_->newest = frame;
  for (const auto& inlet : inlets_->inlets) push_frame(GST_APP_SRC(inlet.get()), *frame);
}

// Removes the sessions of clients that disconnected without TEARDOWN.
gboolean RtspOutput::on_tick(gpointer data) {
  auto* self = static_cast<RtspOutput*>(data);
  const Ref<GstRTSPSessionPool> pool(gst_rtsp_server_get_session_pool(self->server_.get()));
  gst_rtsp_session_pool_cleanup(pool.get());
  return G_SOURCE_CONTINUE;
}

}  // namespace live
