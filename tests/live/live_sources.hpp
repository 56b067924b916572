#pragma once  // SPDX-License-Identifier: MIT

// Sources of ellipse-live in the tests, and its reports about them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"

namespace support {

inline std::string make_video(const TemporaryFolder& folder,
                              int frames,
                              const std::string& size = "width=320,height=180") {
  const std::string file = folder.file("video.mkv");
  EXPECT_EQ(run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                         " ! video/x-raw,format=I420," + size +
                         " ! jpegenc ! matroskamux ! filesink location=" + file),
            "");
  return file;
}

inline std::string make_pictures(const TemporaryFolder& folder, int frames) {
  const std::string pictures = folder.file("pictures");
  std::filesystem::create_directory(pictures);
  EXPECT_EQ(run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                         " ! video/x-raw,format=I420,width=320,height=180 ! jpegenc ! "
                         "multifilesink location=" +
                         pictures + "/flight-%d.jpg"),
            "");
  std::ofstream(pictures + "/notes.txt") << "no picture";
  return pictures;
}

// A file as cameras and phones record it: H.264 with sound.
inline std::string make_mp4(const TemporaryFolder& folder, int frames) {
  const std::string file = folder.file("video.mp4");
  EXPECT_EQ(run_pipeline("ellipsetestsrc num-buffers=" + std::to_string(frames) +
                         " ! video/x-raw,width=320,height=180 ! videoconvert ! x264enc ! "
                         "mp4mux name=mux ! filesink location=" +
                         file + " audiotestsrc num-buffers=40 ! audioconvert ! avenc_aac ! mux."),
            "");
  return file;
}

/// A member of api/source; "" or -1 without an answer.
inline std::string text_in(const Client& client, const char* member) {
  const Answer answer = client.get("api/source");
  return answer.object() != nullptr ? json_object_get_string_member(answer.object(), member) : "";
}

inline gint64 number_in(const Client& client, const char* member) {
  const Answer answer = client.get("api/source");
  return answer.object() != nullptr ? json_object_get_int_member(answer.object(), member) : -1;
}

/// The time of the current frame once it is paused; -1 on timeout.
inline gint64 shown_when_paused(const Client& client) {
  Answer answer;
  const bool is_paused = wait_until([&] {
    answer = client.get("api/source");
    return answer.object() != nullptr &&
           json_object_get_string_member(answer.object(), "state") == std::string("paused");
  });
  return is_paused ? json_object_get_int_member(answer.object(), "pts_ns") : -1;
}

inline bool stands_still(const Client& client) {
  return shown_when_paused(client) >= 0;
}

/// Pauses after some frames.
inline bool is_paused(const Client& client) {
  return wait_until([&] { return client.stat("frames") > 3; }) &&
         client.post("api/pause").status == 200U && stands_still(client);
}

}  // namespace support
