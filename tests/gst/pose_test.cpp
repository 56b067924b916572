// SPDX-License-Identifier: MIT
//
// The camera properties and their effect on metadata, JSON and messages.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "core/camera/camera.hpp"
#include "core/camera/camera_file.hpp"
#include "core/scene/catalog.hpp"
#include "tests/gst/support.hpp"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using support::BusTap;
using support::gray_buffer_of;
using support::harness_of;
using support::object_of;
using support::Owned;
using support::TemporaryFolder;

constexpr int kPoses = 40;
constexpr double kHfovRad = 1.012;  // of the test source's scenes

// The pad's centre and normal in the camera frame [pad radii] at a time of a scene.
std::pair<Vector3d, Vector3d> truth_at(const char* scene, double time_s) {
  const ellipse::Camera camera = ellipse::Camera::with_hfov(kHfovRad, 640, 360);
  Eigen::Matrix3d plane = camera.matrix().inverse() *
                          ellipse::image_from_pad(ellipse::scene_by_name(scene), time_s, 640, 360);
  plane /= plane.col(0).norm();
  return {plane.col(2), plane.col(0).cross(plane.col(1)).normalized()};
}

Vector3d vector_in(JsonObject* object, const char* name) {
  JsonObject* vector = json_object_get_object_member(object, name);
  return {json_object_get_double_member(vector, "x"),
          json_object_get_double_member(vector, "y"),
          json_object_get_double_member(vector, "z")};
}

JsonObject* member_of(JsonArray* targets, const char* role) {
  for (guint i = 0; i < json_array_get_length(targets); ++i) {
    JsonObject* target = json_array_get_object_element(targets, i);
    if (std::strcmp(json_object_get_string_member(target, "role"), role) == 0) return target;
  }
  return nullptr;
}

// @return The JSON lines of a scene, tracked with these properties.
std::vector<Owned<JsonParser>> lines_of(const std::string& scene, const std::string& properties) {
  const TemporaryFolder folder;
  const std::string file = folder.file("lines");
  EXPECT_EQ(support::run_pipeline("ellipsetestsrc scene=" + scene +
                                  " num-buffers=" + std::to_string(kPoses) + " ! ellipsetrack " +
                                  properties + " ! ellipsejson ! filesink location=" + file),
            "");
  return support::read_ndjson(file);
}

// The target of each line.
std::vector<JsonObject*> targets_of(const std::vector<Owned<JsonParser>>& lines) {
  std::vector<JsonObject*> targets;
  for (const auto& line : lines) {
    targets.push_back(
        member_of(json_object_get_array_member(object_of(line), "targets"), "target"));
  }
  return targets;
}

TEST(Pose, MatchesTheSceneInEachLine) {
  for (const char* scene : {"oblique", "orbit"}) {
    const auto lines = lines_of(scene, "hfov=1.012 target-diameter=2");
    const auto targets = targets_of(lines);
    ASSERT_EQ(targets.size(), static_cast<std::size_t>(kPoses));
    for (std::size_t i = 0; i < targets.size(); ++i) {
      ASSERT_NE(targets[i], nullptr) << scene << " " << i;
      const auto [position, normal] = truth_at(scene, static_cast<double>(i) / 30.0);
      EXPECT_LT((vector_in(targets[i], "position") - position).norm(), 0.01 * position.norm());
      EXPECT_GT(vector_in(targets[i], "bearing").dot(position.normalized()), 1.0 - 2e-6);
      EXPECT_NEAR(json_object_get_double_member(targets[i], "angle_x"),
                  std::atan2(position.x(), position.z()),
                  2e-3);
      EXPECT_NEAR(json_object_get_double_member(targets[i], "angle_y"),
                  std::atan2(position.y(), position.z()),
                  2e-3);
      // The first frame is a detection without tracking; its accuracy is a tenth of a pixel.
      if (i == 0) continue;
      EXPECT_GT(vector_in(targets[i], "normal").dot(normal), std::cos(0.026)) << scene << " " << i;
      JsonArray* covariance = json_object_get_array_member(targets[i], "position_covariance");
      ASSERT_EQ(json_array_get_length(covariance), 6U);
      EXPECT_GT(json_array_get_double_element(covariance, 5), 0.0);
    }
  }
}

TEST(Pose, IsCertainInTheFirstFrameWithGravity) {
  const auto [position, normal] = truth_at("orbit", 0.0);
  std::ostringstream gravity;
  gravity << "gravity=\"<" << -normal.x() << "," << -normal.y() << "," << -normal.z() << ">\"";
  const auto lines = lines_of("orbit", "hfov=1.012 tracking=none " + gravity.str());
  JsonObject* target = targets_of(lines).front();
  ASSERT_NE(target, nullptr);
  EXPECT_GT(vector_in(target, "normal").dot(normal), std::cos(0.1));
  EXPECT_GT(json_object_get_double_member(target, "certainty"), 0.99);
}

TEST(Pose, HasNoPositionWithoutADiameter) {
  const auto lines = lines_of("orbit", "fx=577");
  JsonObject* target = targets_of(lines).back();
  ASSERT_NE(target, nullptr);
  EXPECT_TRUE(json_object_has_member(target, "bearing"));
  EXPECT_TRUE(json_object_has_member(target, "normal"));
  EXPECT_FALSE(json_object_has_member(target, "position"));
}

TEST(Pose, IsAbsentWithoutACamera) {
  const auto lines = lines_of("orbit", "target-diameter=2");
  JsonObject* target = targets_of(lines).back();
  ASSERT_NE(target, nullptr);
  for (const char* name : {"bearing", "angle_x", "centre", "normal", "position"}) {
    EXPECT_FALSE(json_object_has_member(target, name)) << name;
  }
}

// Properties.

std::string camera_file(const TemporaryFolder& folder, const char* distortion) {
  const std::string path = folder.file("camera.yaml");
  std::ofstream(path) << "image_width: 640\nimage_height: 360\n"
                         "camera_matrix:\n  rows: 3\n  cols: 3\n"
                         "  data: [577., 0., 319.5, 0., 577., 179.5, 0., 0., 1.]\n"
                         "distortion_model: plumb_bob\n"
                         "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: ["
                      << distortion << "]\n";
  return path;
}

support::GrayPicture picture_at(double time_s) {
  support::GrayPicture picture(640, 360);
  ellipse::SceneRenderer(ellipse::scene_by_name("orbit")).render(time_s, 0, picture.writable());
  return picture;
}

class PoseElement : public testing::Test {
 protected:
  Owned<GstHarness> harness_ = harness_of("ellipsetrack name=track messages=every-frame",
                                          support::caps_of("GRAY8", 640, 360),
                                          support::caps_of("GRAY8", 640, 360));
  Owned<GstElement> element_{gst_harness_find_element(harness_.get(), "ellipsetrack")};

  Owned<GstBuffer> push(double time_s) {
    return Owned<GstBuffer>(
        gst_harness_push_and_pull(harness_.get(), gray_buffer_of(picture_at(time_s)).release()));
  }
};

TEST_F(PoseElement, RejectsInvalidCameraFilesAndKeepsTheOldOne) {
  const TemporaryFolder folder;
  const std::string good = camera_file(folder, "-0.2, 0.03, 0., 0., 0.");
  const std::string bad = folder.file("bad.yaml");
  std::ofstream(bad) << "image_width: 640\nimage_height: none\n";
  g_object_set(element_.get(), "camera-file", good.c_str(), nullptr);
  BusTap bus(element_.get());
  g_object_set(element_.get(), "camera-file", bad.c_str(), nullptr);
  gchar* kept = nullptr;
  g_object_get(element_.get(), "camera-file", &kept, nullptr);
  EXPECT_EQ(kept, good);
  g_free(kept);
  const auto warning = bus.pop(GST_MESSAGE_WARNING);
  ASSERT_TRUE(warning);
  GError* error = nullptr;
  gst_message_parse_warning(warning.get(), &error, nullptr);
  EXPECT_NE(std::string(error->message).find(bad + ":2: image_height"), std::string::npos)
      << error->message;
  g_error_free(error);
}

TEST_F(PoseElement, ReportsThePoseInMetaMessagesAndStructures) {
  g_object_set(element_.get(), "hfov", kHfovRad, "target-diameter", 2.0, nullptr);
  BusTap bus(element_.get());
  const auto buffer = push(0.0);
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
  ASSERT_NE(meta, nullptr);
  EXPECT_TRUE(meta->has_pose);
  EXPECT_TRUE(meta->has_position);
  EXPECT_EQ(meta->n_outline, 0U);
  const auto message = bus.pop(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(message);
  const GstStructure* fields = gst_message_get_structure(message.get());
  double z = 0.0;
  EXPECT_TRUE(gst_structure_get_double(fields, "position_z", &z));
  EXPECT_EQ(z, meta->position_z);
  EXPECT_EQ(gst_value_array_get_size(gst_structure_get_value(fields, "position_covariance")), 6U);
}

// The scene has no lens, so its undistorted outline is not an ellipse. The reported outline must
// lie on the edge in the picture nevertheless.
TEST_F(PoseElement, DistortsTheOutlineBackIntoThePicture) {
  const TemporaryFolder folder;
  g_object_set(element_.get(),
               "camera-file",
               camera_file(folder, "-0.22, 0.03, 0., 0., 0.").c_str(),
               nullptr);
  const auto buffer = push(0.0);
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
  ASSERT_NE(meta, nullptr);
  ASSERT_EQ(meta->n_outline, 64U);
  const ellipse::Ellipse expected = *ellipse::project_circle(
      ellipse::image_from_pad(ellipse::scene_by_name("orbit"), 0.0, 640, 360), 1.0);
  for (guint i = 0; i < meta->n_outline; ++i) {
    const Vector2d point(meta->outline[2 * i], meta->outline[2 * i + 1]);
    EXPECT_LT(std::abs(ellipse::sampson_distance(expected, point)), 0.5) << i;
  }
}

// The visible part in the picture, not in the ideal plane: undistorted, the frame cuts the disc in
// the corner.
TEST_F(PoseElement, ReportsTheVisiblePartOfCandidatesInThePicture) {
  const TemporaryFolder folder;
  g_object_set(element_.get(),
               "camera-file",
               camera_file(folder, "-0.22, 0.03, 0., 0., 0.").c_str(),
               "candidates",
               TRUE,
               nullptr);
  support::GrayPicture picture(640, 360, 90);
  cv::Mat luma(360, 640, CV_8UC1, picture.pixels.data());
  cv::circle(luma, {320, 180}, 60, 230, cv::FILLED, cv::LINE_AA);
  cv::circle(luma, {590, 40}, 30, 230, cv::FILLED, cv::LINE_AA);
  const Owned<GstBuffer> buffer(
      gst_harness_push_and_pull(harness_.get(), gray_buffer_of(picture).release()));
  const GstEllipseMeta* corner =
      gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_CANDIDATE);
  ASSERT_NE(corner, nullptr);
  EXPECT_GT(corner->cx + corner->semi_major, 640.0);
  EXPECT_EQ(corner->visible_fraction, 1.0);
}

TEST(PoseMeta, FollowsAScaler) {
  const GstVideoInfo in = support::info_of("GRAY8", 320, 240);
  const GstVideoInfo out = support::info_of("GRAY8", 640, 480);
  const Owned<GstBuffer> from(gst_buffer_new());
  const Owned<GstBuffer> to(gst_buffer_new());
  support::add_circle(from.get(), 100.0, 80.0, 30.0);
  GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(from.get(), GST_ELLIPSE_ROLE_TARGET);
  meta->has_pose = TRUE;
  meta->centre_x = 99.5;
  meta->position_z = 4.0;
  meta->n_outline = 64;
  meta->outline[0] = 129.5F;
  meta->outline[1] = 79.5F;
  GstVideoMetaTransform transform = {const_cast<GstVideoInfo*>(&in),
                                     const_cast<GstVideoInfo*>(&out)};
  ASSERT_TRUE(GST_ELLIPSE_META_INFO->transform_func(to.get(),
                                                    reinterpret_cast<GstMeta*>(meta),
                                                    from.get(),
                                                    gst_video_meta_transform_scale_get_quark(),
                                                    &transform));
  const GstEllipseMeta* scaled = gst_buffer_get_ellipse_meta(to.get(), GST_ELLIPSE_ROLE_TARGET);
  ASSERT_NE(scaled, nullptr);
  EXPECT_DOUBLE_EQ(scaled->centre_x, 199.5);
  EXPECT_FLOAT_EQ(scaled->outline[0], 259.5F);
  EXPECT_FLOAT_EQ(scaled->outline[1], 159.5F);
  EXPECT_EQ(scaled->position_z, 4.0);
}

// The overlay draws the outline's points, if any, in place of the ellipse.
TEST(PoseMeta, IsDrawnAlongItsOutline) {
  const auto harness = harness_of("ellipseoverlay overlay=ellipse",
                                  support::caps_of("GRAY8", 320, 240),
                                  support::caps_of("GRAY8", 320, 240));
  auto buffer = gray_buffer_of(support::GrayPicture(320, 240));
  support::add_circle(buffer.get(), 160.0, 120.0, 30.0);
  GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
  meta->n_outline = 64;
  const ellipse::Ellipse bent{160.0, 120.0, 80.0, 60.0, 0.0};
  for (guint i = 0; i < meta->n_outline; ++i) {
    const Vector2d point = bent.point_at(2.0 * M_PI * i / meta->n_outline);
    meta->outline[2 * i] = static_cast<float>(point.x());
    meta->outline[2 * i + 1] = static_cast<float>(point.y());
  }
  const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer.release()));
  const support::GrayPicture drawn =
      support::picture_of(out.get(), support::info_of("GRAY8", 320, 240));
  int on_outline = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector2d point = bent.point_at(2.0 * M_PI * i / 200);
    const auto x = static_cast<int>(std::lround(point.x()));
    const auto y = static_cast<int>(std::lround(point.y()));
    on_outline += drawn.view().row(y)[x] > 60 ? 1 : 0;
  }
  EXPECT_EQ(on_outline, 200);
  EXPECT_EQ(drawn.view().row(120)[190], 0) << "the ellipse itself";
}

}  // namespace
