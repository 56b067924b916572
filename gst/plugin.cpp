/* SPDX-License-Identifier: MIT */
#include <gst/gst.h>

#include "gst/gstellipsejson.h"
#include "gst/overlay/gstellipseoverlay.h"
#include "gst/testsrc/gstellipsetestsrc.h"
#include "gst/track/gstellipsetrack.h"

static gboolean plugin_init(GstPlugin* plugin) {
  return GST_ELEMENT_REGISTER(ellipsetrack, plugin) &&
         GST_ELEMENT_REGISTER(ellipseoverlay, plugin) &&
         GST_ELEMENT_REGISTER(ellipsejson, plugin) && GST_ELEMENT_REGISTER(ellipsetestsrc, plugin);
}

GST_PLUGIN_DEFINE(GST_VERSION_MAJOR,
                  GST_VERSION_MINOR,
                  ellipsetrack,
                  "Detects and tracks an elliptical target",
                  plugin_init,
                  VERSION,
                  "MIT/X11",
                  PACKAGE,
                  "https://gst-ellipse.example")
