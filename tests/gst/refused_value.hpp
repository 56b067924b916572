#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <cstring>

namespace support {

/// Whether this is how GLib says that a value lies outside of a property's range and was not set.
/// Up to 2.82 it is a warning, from 2.84 on a critical.
inline bool is_refused_value(const gchar* domain, const gchar* text) {
  return domain != nullptr && std::strcmp(domain, "GLib-GObject") == 0 &&
         std::strstr(text, "is invalid or out of range for property") != nullptr;
}

}  // namespace support
