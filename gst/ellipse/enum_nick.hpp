#pragma once  // SPDX-License-Identifier: MIT

#include <glib-object.h>

#include <cstring>

/// The nick of a field's value; "unknown" if it has none. The field is read as an integer, because
/// untrusted metadata may hold a number that is not a value of the enum. Static string.
template <class Enum>
const gchar* nick_of(GType type, const Enum* field) {
  gint number = 0;
  static_assert(sizeof(Enum) == sizeof(gint));
  std::memcpy(&number, field, sizeof number);
  auto* enum_class = static_cast<GEnumClass*>(g_type_class_ref(type));
  const GEnumValue* entry = g_enum_get_value(enum_class, number);
  g_type_class_unref(enum_class);  // static types keep their strings
  return entry != nullptr ? entry->value_nick : "unknown";
}
