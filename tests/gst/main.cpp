// SPDX-License-Identifier: MIT
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/gst/refused_value.hpp"

namespace {

// Tests set properties out of range. GLib rejects such values before they reach an element; some
// versions log a critical.
gboolean is_fatal(const gchar* domain, GLogLevelFlags, const gchar* text, gpointer) {
  return support::is_refused_value(domain, text) ? FALSE : TRUE;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  gst_init(&argc, &argv);
  // A critical of an element is a bug: no test may cause one.
  g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_LEVEL_CRITICAL | G_LOG_FATAL_MASK));
  g_test_log_set_fatal_handler(is_fatal, nullptr);
  const int status = RUN_ALL_TESTS();
  gst_deinit();
  return status;
}
