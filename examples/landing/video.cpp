// SPDX-License-Identifier: MIT
#include "examples/landing/video.hpp"

#include <gst/app/app.h>
#include <gst/gst.h>

#include <opencv2/core/mat.hpp>

#include "examples/evaluate/text.hpp"
#include "examples/landing/map.hpp"
#include "examples/landing/pipeline.hpp"

namespace landing {
namespace {

constexpr int kViewWidth = 640;
constexpr int kViewHeight = 360;

std::string line_of(const ellipse::Camera& camera, int rate) {
  return evaluate::format(
      "appsrc name=view format=time "
      "caps=video/x-raw,format=GRAY8,width=%d,height=%d,framerate=%d/1 ! videoconvert ! "
      "videoscale ! video/x-raw,format=RGBx,width=%d,height=%d ! "
      "ellipseoverlay overlay=ellipse+centre ! mix.sink_0 "
      "appsrc name=map format=time "
      "caps=video/x-raw,format=RGB,width=%d,height=%d,framerate=%d/1 ! videoconvert ! mix.sink_1 "
      "compositor name=mix sink_1::xpos=%d ! videoconvert ! jpegenc quality=75 ! matroskamux ! "
      "filesink name=file",
      camera.width,
      camera.height,
      rate,
      kViewWidth,
      kViewHeight,
      Map::kWidth,
      Map::kHeight,
      rate,
      kViewWidth);
}

// Writes two pictures side by side to a file.
class Film {
 public:
  Film(const ellipse::Camera& camera, int rate, const std::string& file)
      : pipeline_(line_of(camera, rate)),
        view_(pipeline_.element("view")),
        map_(pipeline_.element("map")) {
    g_object_set(pipeline_.element("file").get(), "location", file.c_str(), nullptr);
    pipeline_.play();
  }

  void add(GstSample* view, const cv::Mat& map) {
    GstBuffer* camera_buffer = gst_sample_get_buffer(view);
    const gsize size = map.total() * map.elemSize();
    GstBuffer* map_buffer = gst_buffer_new_memdup(map.data, size);
    GST_BUFFER_PTS(map_buffer) = GST_BUFFER_PTS(camera_buffer);
    GST_BUFFER_DURATION(map_buffer) = GST_BUFFER_DURATION(camera_buffer);
    pipeline_.push(map_, map_buffer);
    pipeline_.push(view_, gst_buffer_ref(camera_buffer));
  }

  void finish() {
    gst_app_src_end_of_stream(GST_APP_SRC(view_.get()));
    gst_app_src_end_of_stream(GST_APP_SRC(map_.get()));
    pipeline_.await_end();
  }

 private:
  Pipeline pipeline_;
  Element view_;
  Element map_;
};

}  // namespace

void film(const Flight& flight, const std::string& file) {
  Film film(flight.rig.camera, flight.rate, file);
  Map map(flight);
  (void)fly(flight,
            [&](const Moment& moment, GstSample* sample) { film.add(sample, map.draw(moment)); });
  film.finish();
}

}  // namespace landing
