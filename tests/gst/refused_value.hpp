#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <cstring>

namespace support {

/// Whether this is GLib's message about a value outside a property's range, which was not set. It
/// is a warning up to 2.82 and a critical from 2.84 on.
inline bool is_refused_value(const gchar* domain, const gchar* text) {
  return domain != nullptr && std::strcmp(domain, "GLib-GObject") == 0 &&
         std::strstr(text, "is invalid or out of range for property") != nullptr;
}

}  // namespace support
