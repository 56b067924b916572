#pragma once /* SPDX-License-Identifier: MIT */

#include <gst/base/gstpushsrc.h>

G_BEGIN_DECLS

#define GST_TYPE_ELLIPSE_TEST_SRC (gst_ellipse_test_src_get_type())
G_DECLARE_FINAL_TYPE(GstEllipseTestSrc, gst_ellipse_test_src, GST, ELLIPSE_TEST_SRC, GstPushSrc)

GST_ELEMENT_REGISTER_DECLARE(ellipsetestsrc)

G_END_DECLS
