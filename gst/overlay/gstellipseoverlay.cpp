/* SPDX-License-Identifier: MIT */

/**
 * SECTION:element-ellipseoverlay
 * @title: ellipseoverlay
 *
 * Draws the #GstEllipseMeta of a buffer. It needs nothing else, so it can follow a tee, a scaler or
 * a decoder that keeps metadata. A buffer without an ellipse passes unchanged.
 *
 * If downstream blends overlays itself, as GPU sinks do, the drawing is attached to the buffer as
 * #GstVideoOverlayCompositionMeta; otherwise it is drawn into the pixels.
 *
 * |[
 * gst-launch-1.0 ellipsetestsrc ! ellipsetrack ! videoscale ! video/x-raw,width=1280,height=720 \
 *     ! ellipseoverlay ! videoconvert ! autovideosink
 * ]|
 *
 * Since: 0.1
 */

#include "gst/overlay/gstellipseoverlay.h"

#include <algorithm>
#include <exception>

#include "gst/overlay/blend.hpp"
#include "gst/overlay/composition.hpp"
#include "gst/overlay/overlay.hpp"
#include "gst/track/video_view.hpp"

enum { PROP_0, PROP_TRUTH, PROP_FIRST_OF_STYLE };

static constexpr auto kDefaultParts = static_cast<GstEllipseOverlayFlags>(
    GST_ELLIPSE_OVERLAY_ELLIPSE | GST_ELLIPSE_OVERLAY_CENTRE | GST_ELLIPSE_OVERLAY_LABEL);
static constexpr guint kTruthColor = 0xffff4040U;
static constexpr guint kCandidateColor = 0xffb0b0b0;

struct _GstEllipseOverlay {
  GstVideoFilter parent;

  // Under the object lock.
  OverlayStyle* style;
  gboolean shows_truth;

  // Used by the streaming thread only.
  Overlay* overlay;
  bool composes;  // downstream blends the overlay
};

G_DEFINE_TYPE(GstEllipseOverlay, gst_ellipse_overlay, GST_TYPE_VIDEO_FILTER)

GST_ELEMENT_REGISTER_DEFINE(ellipseoverlay,
                            "ellipseoverlay",
                            GST_RANK_NONE,
                            GST_TYPE_ELLIPSE_OVERLAY)

static void gst_ellipse_overlay_set_property(GObject* object,
                                             guint id,
                                             const GValue* value,
                                             GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_OVERLAY(object);
  GST_OBJECT_LOCK(self);
  if (id == PROP_TRUTH) {
    self->shows_truth = g_value_get_boolean(value);
  } else {
    set_overlay_property(*self->style, pspec->name, value);
  }
  GST_OBJECT_UNLOCK(self);
}

static void gst_ellipse_overlay_get_property(GObject* object,
                                             guint id,
                                             GValue* value,
                                             GParamSpec* pspec) {
  auto* self = GST_ELLIPSE_OVERLAY(object);
  GST_OBJECT_LOCK(self);
  if (id == PROP_TRUTH) {
    g_value_set_boolean(value, self->shows_truth);
  } else {
    get_overlay_property(*self->style, pspec->name, value);
  }
  GST_OBJECT_UNLOCK(self);
}

/* Whether to draw into the pixels or beside them */

static bool has_composition(const GstCapsFeatures* features) {
  return gst_caps_features_contains(features, GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION);
}

// Appends one structure of the caps with the feature, or without it.
static void append(GstCaps* to, GstCaps* from, guint index, bool is_composed) {
  GstCapsFeatures* features = gst_caps_features_copy(gst_caps_get_features(from, index));
  if (is_composed && !has_composition(features)) {
    gst_caps_features_add(features, GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION);
  } else if (!is_composed) {
    gst_caps_features_remove(features, GST_CAPS_FEATURE_META_GST_VIDEO_OVERLAY_COMPOSITION);
  }
  gst_caps_append_structure_full(
      to, gst_structure_copy(gst_caps_get_structure(from, index)), features);
}

// The element may add the feature to the caps, but never removes it.
static GstCaps* gst_ellipse_overlay_transform_caps(GstBaseTransform*,
                                                   GstPadDirection direction,
                                                   GstCaps* caps,
                                                   GstCaps* filter) {
  GstCaps* result = gst_caps_new_empty();
  for (guint i = 0; i < gst_caps_get_size(caps); ++i) {
    const bool is_composed = has_composition(gst_caps_get_features(caps, i));
    if (direction == GST_PAD_SINK || is_composed) append(result, caps, i, true);
    if (direction == GST_PAD_SRC || !is_composed) append(result, caps, i, false);
  }
  if (filter == nullptr) return result;
  GstCaps* filtered = gst_caps_intersect_full(filter, result, GST_CAPS_INTERSECT_FIRST);
  gst_caps_unref(result);
  return filtered;
}

// The first of the caps with the feature, or without it, fixated. NULL if there is none.
static GstCaps* first_of(GstCaps* caps, bool is_composed) {
  for (guint i = 0; i < gst_caps_get_size(caps); ++i) {
    if (has_composition(gst_caps_get_features(caps, i)) != is_composed) continue;
    return gst_caps_fixate(gst_caps_copy_nth(caps, i));
  }
  return nullptr;
}

static bool downstream_composes(GstBaseTransform* base, GstCaps* caps) {
  // Some elements answer only for their current caps.
  if (!gst_pad_set_caps(GST_BASE_TRANSFORM_SRC_PAD(base), caps)) return false;
  GstQuery* query = gst_query_new_allocation(caps, FALSE);
  const bool composes = gst_pad_peer_query(GST_BASE_TRANSFORM_SRC_PAD(base), query) &&
                        gst_query_find_allocation_meta(
                            query, GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE, nullptr) != FALSE;
  gst_query_unref(query);
  return composes;
}

// Like textoverlay, attaches the drawing as metadata if downstream has the feature in its caps and
// also requests the metadata. The metadata alone is not enough: scalers pass it on unscaled.
static GstCaps* gst_ellipse_overlay_fixate_caps(GstBaseTransform* base,
                                                GstPadDirection direction,
                                                GstCaps* caps,
                                                GstCaps* othercaps) {
  auto* self = GST_ELLIPSE_OVERLAY(base);
  if (direction == GST_PAD_SRC) {
    return GST_BASE_TRANSFORM_CLASS(gst_ellipse_overlay_parent_class)
        ->fixate_caps(base, direction, caps, othercaps);
  }
  GstCaps* composed = first_of(othercaps, true);
  GstCaps* plain = first_of(othercaps, false);
  gst_caps_unref(othercaps);
  self->composes = composed != nullptr && downstream_composes(base, composed);
  if (composed != nullptr && (self->composes || plain == nullptr)) {
    gst_clear_caps(&plain);
    return composed;
  }
  gst_clear_caps(&composed);
  return plain;
}

/* Drawing */

static void draw_all(Overlay& overlay,
                     GstBuffer* buffer,
                     const OverlayStyle& style,
                     bool shows_truth) {
  OverlayStyle truth_style = style;
  truth_style.color_argb = kTruthColor;
  const OverlayStyle candidate_style{GST_ELLIPSE_OVERLAY_ELLIPSE,
                                     kCandidateColor,
                                     std::max(1U, style.line_width_px / 2),
                                     style.has_casing};
  gpointer state = nullptr;
  while (GstEllipseMeta* meta = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    if (meta->role == GST_ELLIPSE_ROLE_TRUTH) {
      if (shows_truth) overlay.draw(*meta, truth_style);
    } else if (meta->role == GST_ELLIPSE_ROLE_CANDIDATE) {
      overlay.draw(*meta, candidate_style);
    } else {
      overlay.draw(*meta, style);
    }
  }
}

static void show(GstEllipseOverlay* self, GstBuffer* buffer) {
  if (self->composes) {
    attach_composition(buffer, self->overlay->canvas());
    return;
  }
  MappedFrame mapped(GST_VIDEO_FILTER(self)->in_info, buffer, GST_MAP_READWRITE);
  if (mapped.is_mapped()) {
    blend(self->overlay->canvas(), mapped.frame());
  } else {
    GST_ELEMENT_WARNING(
        self, RESOURCE, WRITE, ("Cannot map a buffer for writing."), ("it passes unchanged"));
  }
}

static GstFlowReturn gst_ellipse_overlay_transform_ip(GstBaseTransform* base, GstBuffer* buffer) {
  auto* self = GST_ELLIPSE_OVERLAY(base);
  GST_OBJECT_LOCK(self);
  OverlayStyle style = *self->style;
  const bool shows_truth = self->shows_truth != FALSE;
  GST_OBJECT_UNLOCK(self);

  const GstVideoInfo& info = GST_VIDEO_FILTER(base)->in_info;
  style.has_casing = !self->composes && GST_VIDEO_INFO_IS_GRAY(&info);
  try {
    self->overlay->begin(GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info));
    draw_all(*self->overlay, buffer, style, shows_truth);
    if (!self->overlay->canvas().tiles().empty()) show(self, buffer);
  } catch (const std::exception& error) {
    GST_ELEMENT_WARNING(
        self, STREAM, FAILED, ("Cannot draw on a frame: %s", error.what()), ("the frame passes"));
  }
  return GST_FLOW_OK;
}

static gboolean gst_ellipse_overlay_accept_caps(GstBaseTransform* base,
                                                GstPadDirection direction,
                                                GstCaps* caps) {
  const gboolean is_accepted = GST_BASE_TRANSFORM_CLASS(gst_ellipse_overlay_parent_class)
                                   ->accept_caps(base, direction, caps);
  if (!is_accepted && direction == GST_PAD_SINK) report_unsupported_caps(base, caps);
  return is_accepted;
}

static gboolean gst_ellipse_overlay_propose_allocation(GstBaseTransform* base,
                                                       GstQuery* decide_query,
                                                       GstQuery* query) {
  gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
  return GST_BASE_TRANSFORM_CLASS(gst_ellipse_overlay_parent_class)
      ->propose_allocation(base, decide_query, query);
}

static void gst_ellipse_overlay_finalize(GObject* object) {
  auto* self = GST_ELLIPSE_OVERLAY(object);
  delete self->overlay;
  delete self->style;
  G_OBJECT_CLASS(gst_ellipse_overlay_parent_class)->finalize(object);
}

static void gst_ellipse_overlay_init(GstEllipseOverlay* self) {
  self->style = new OverlayStyle();
  self->style->parts = kDefaultParts;
  self->overlay = new Overlay();
  gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
}

static void gst_ellipse_overlay_class_init(GstEllipseOverlayClass* klass) {
  auto* object_class = G_OBJECT_CLASS(klass);
  object_class->set_property = gst_ellipse_overlay_set_property;
  object_class->get_property = gst_ellipse_overlay_get_property;
  object_class->finalize = gst_ellipse_overlay_finalize;
  g_object_class_install_property(
      object_class,
      PROP_TRUTH,
      g_param_spec_boolean("truth",
                           "Truth",
                           "Also draw the ground truth of a test source",
                           FALSE,
                           static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                    GST_PARAM_MUTABLE_PLAYING)));
  guint id = PROP_FIRST_OF_STYLE;
  for (GParamSpec* spec : overlay_param_specs(kDefaultParts)) {
    g_object_class_install_property(object_class, id++, spec);
  }

  auto* element_class = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element_class,
                                        "Ellipse overlay",
                                        "Filter/Effect/Video",
                                        "Draws the ellipses that buffers carry as metadata",
                                        "The gst-ellipse authors");
  add_composing_pad_templates(element_class);

  auto* base_class = GST_BASE_TRANSFORM_CLASS(klass);
  base_class->transform_ip = gst_ellipse_overlay_transform_ip;
  base_class->transform_caps = gst_ellipse_overlay_transform_caps;
  base_class->fixate_caps = gst_ellipse_overlay_fixate_caps;
  base_class->accept_caps = gst_ellipse_overlay_accept_caps;
  base_class->propose_allocation = gst_ellipse_overlay_propose_allocation;
}
