// SPDX-License-Identifier: MIT
#include "gst/testsrc/scene_properties.hpp"

#include <span>
#include <vector>

#include "core/scene/catalog.hpp"
#include "core/scene/wild.hpp"

namespace {

// In the order of their ids.
enum { PROP_SCENE, PROP_PATTERN, PROP_GROUND, PROP_LENS, PROP_NOISE, PROP_SEED };

// The value of "scene" after those of the catalog.
gint wild_scene_number() {
  return static_cast<gint>(ellipse::scene_catalog().size());
}

GType gst_ellipse_scene_get_type() {
  static const GType kType = [] {
    static std::vector<GEnumValue> values;
    gint number = 0;
    for (const ellipse::NamedScene& scene : ellipse::scene_catalog()) {
      values.push_back({number++, scene.description, scene.name});
    }
    values.push_back({number, "Random scene, defined by the seed", "wild"});
    values.push_back({0, nullptr, nullptr});
    return g_enum_register_static("GstEllipseScene", values.data());
  }();
  return kType;
}

GType register_nicks(const char* name,
                     std::span<const char* const> nicks,
                     std::vector<GEnumValue>& values) {
  values.push_back({SceneProperties::kAsTheScene, "The scene's own", "scene"});
  gint number = 0;
  for (const char* nick : nicks) values.push_back({number++, nick, nick});
  values.push_back({0, nullptr, nullptr});
  return g_enum_register_static(name, values.data());
}

GType gst_ellipse_pattern_get_type() {
  static std::vector<GEnumValue> values;
  static const GType kType = register_nicks("GstEllipsePattern", ellipse::pattern_nicks(), values);
  return kType;
}

GType gst_ellipse_ground_get_type() {
  static std::vector<GEnumValue> values;
  static const GType kType = register_nicks("GstEllipseGround", ellipse::ground_nicks(), values);
  return kType;
}

GType gst_ellipse_lens_get_type() {
  static const GType kType = [] {
    static std::vector<GEnumValue> values = {{SceneProperties::kNoLens, "None: pinhole", "none"}};
    for (const ellipse::NamedLens& lens : ellipse::lens_catalog()) {
      values.push_back({static_cast<gint>(values.size()), lens.description, lens.name});
    }
    values.push_back({0, nullptr, nullptr});
    return g_enum_register_static("GstEllipseLens", values.data());
  }();
  return kType;
}

}  // namespace

void SceneProperties::install(GObjectClass* object_class, guint first_id) {
  const auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                              GST_PARAM_MUTABLE_PLAYING);
  const auto install = [&](guint id, GParamSpec* spec) {
    g_object_class_install_property(object_class, first_id + id, spec);
  };
  install(PROP_SCENE,
          g_param_spec_enum(
              "scene", "Scene", "Scene to render", gst_ellipse_scene_get_type(), 0, flags));
  install(PROP_PATTERN,
          g_param_spec_enum("pattern",
                            "Pattern",
                            "Pattern on the pad",
                            gst_ellipse_pattern_get_type(),
                            kAsTheScene,
                            flags));
  install(PROP_GROUND,
          g_param_spec_enum("ground",
                            "Ground",
                            "Ground around the pad",
                            gst_ellipse_ground_get_type(),
                            kAsTheScene,
                            flags));
  install(PROP_LENS,
          g_param_spec_enum(
              "lens", "Lens", "Lens distortion", gst_ellipse_lens_get_type(), kNoLens, flags));
  install(PROP_NOISE,
          g_param_spec_double("noise",
                              "Noise",
                              "Standard deviation of the sensor noise [grey levels]; "
                              "-1 = the scene's own",
                              -1.0,
                              100.0,
                              -1.0,
                              flags));
  install(PROP_SEED,
          g_param_spec_uint("seed",
                            "Seed",
                            "Random seed of ground and noise; with scene=wild, of the whole scene",
                            0,
                            G_MAXUINT32,
                            1,
                            flags));
  for (const GType type : {gst_ellipse_scene_get_type(),
                           gst_ellipse_pattern_get_type(),
                           gst_ellipse_ground_get_type(),
                           gst_ellipse_lens_get_type()}) {
    gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
  }
}

void SceneProperties::set(guint which, const GValue* value) {
  if (which == PROP_SCENE) scene = g_value_get_enum(value);
  if (which == PROP_PATTERN) pattern = g_value_get_enum(value);
  if (which == PROP_GROUND) ground = g_value_get_enum(value);
  if (which == PROP_LENS) lens = g_value_get_enum(value);
  if (which == PROP_NOISE) noise = g_value_get_double(value);
  if (which == PROP_SEED) seed = g_value_get_uint(value);
}

void SceneProperties::get(guint which, GValue* value) const {
  if (which == PROP_SCENE) g_value_set_enum(value, scene);
  if (which == PROP_PATTERN) g_value_set_enum(value, pattern);
  if (which == PROP_GROUND) g_value_set_enum(value, ground);
  if (which == PROP_LENS) g_value_set_enum(value, lens);
  if (which == PROP_NOISE) g_value_set_double(value, noise);
  if (which == PROP_SEED) g_value_set_uint(value, seed);
}

ellipse::Scene SceneProperties::make() const {
  ellipse::Scene result =
      scene == wild_scene_number()
          ? ellipse::wild_scene(seed)
          : ellipse::scene_catalog()[static_cast<std::size_t>(scene)].make(seed);
  if (pattern != kAsTheScene) result.pad.pattern = static_cast<ellipse::Pattern>(pattern);
  if (ground != kAsTheScene) result.ground.kind = static_cast<ellipse::GroundKind>(ground);
  if (lens != kNoLens) {
    ellipse::lens_catalog()[static_cast<std::size_t>(lens - kNoLens - 1)].put_on(result);
  }
  if (noise >= 0.0) result.sensor.read_noise = noise;
  return result;
}

SceneFormat SceneProperties::preferred_format() const {
  if (scene != wild_scene_number()) return {};
  const ellipse::Wild wild = ellipse::make_wild(seed);
  SceneFormat format{wild.width, wild.height};
  gst_util_double_to_fraction(wild.frames_per_second, &format.rate_n, &format.rate_d);
  return format;
}
