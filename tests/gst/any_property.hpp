#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/random.hpp"
#include "tests/gst/refused_value.hpp"

namespace support {

/// The writable properties of an element, in the order of installation.
inline std::vector<GParamSpec*> settings_of(GstElement* element) {
  guint count = 0;
  GParamSpec** all = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  std::vector<GParamSpec*> settings;
  for (guint i = 0; i < count; ++i) {
    const bool is_gst_objects_own = all[i]->owner_type == GST_TYPE_OBJECT;
    if ((all[i]->flags & G_PARAM_WRITABLE) != 0 && !is_gst_objects_own) settings.push_back(all[i]);
  }
  g_free(all);
  return settings;
}

/// A value of a property's type, validated by GLib.
class PropertyValue {
 public:
  explicit PropertyValue(GParamSpec* spec) : spec_(spec) {
    g_value_init(&value_, spec->value_type);
    g_param_value_set_default(spec, &value_);
  }
  ~PropertyValue() { g_value_unset(&value_); }
  PropertyValue(const PropertyValue&) = delete;
  PropertyValue& operator=(const PropertyValue&) = delete;

  /// Types other than numbers keep the default.
  void be(double number) {
    switch (G_TYPE_FUNDAMENTAL(spec_->value_type)) {
      case G_TYPE_DOUBLE:
        g_value_set_double(&value_, number);
        break;
      case G_TYPE_BOOLEAN:
        g_value_set_boolean(&value_, number > 0.0 ? TRUE : FALSE);
        break;
      case G_TYPE_UINT:
        g_value_set_uint(&value_, whole<guint>(number));
        break;
      case G_TYPE_INT:
        g_value_set_int(&value_, whole<gint>(number));
        break;
      case G_TYPE_UINT64:
        g_value_set_uint64(&value_, whole<guint64>(number));
        break;
      case G_TYPE_ENUM:
        g_value_set_enum(&value_, whole<gint>(number));
        break;
      case G_TYPE_FLAGS:
        g_value_set_flags(&value_, whole<guint>(number));
        break;
      default:
        break;
    }
  }
  [[nodiscard]] const GValue& value() const { return value_; }
  /// Whether the value is in the property's range.
  [[nodiscard]] bool is_valid() const { return g_param_value_is_valid(spec_, &value_) != FALSE; }
  void give_to(GstElement* element) const {
    g_object_set_property(G_OBJECT(element), spec_->name, &value_);
  }

 private:
  template <class T>
  static T whole(double number) {
    if (!(number > static_cast<double>(std::numeric_limits<T>::min()))) {
      return std::numeric_limits<T>::min();
    }
    return number < static_cast<double>(std::numeric_limits<T>::max())
               ? static_cast<T>(number)
               : std::numeric_limits<T>::max();
  }

  GParamSpec* spec_;
  GValue value_ = G_VALUE_INIT;
};

inline void set_default(GstElement* element, GParamSpec* spec) {
  PropertyValue(spec).give_to(element);
}

inline constexpr std::array kExtremes{std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::max(),
                                      std::numeric_limits<double>::denorm_min(),
                                      0.0,
                                      -0.0,
                                      1.0,
                                      32768.0};

inline void set_number(GstElement* element, GParamSpec* spec, double number) {
  PropertyValue value(spec);
  value.be(number);
  value.give_to(element);
}

/// A number in a plausible range, sometimes an extreme one.
inline void set_at_random(GstElement* element, GParamSpec* spec, ellipse::Random& random) {
  const bool is_extreme = random.below(8) == 0;
  const auto which = static_cast<std::size_t>(random.below(int(kExtremes.size())));
  const double max = std::array{1.0, 5.0, 1000.0}.at(static_cast<std::size_t>(random.below(3)));
  set_number(element, spec, is_extreme ? kExtremes.at(which) : random.between(0.0, max));
}

/// Suppresses warnings and rejected values, of which there are thousands, while it exists.
class QuietWarnings {
 public:
  QuietWarnings() : before_(g_log_set_default_handler(print_what_is_worse, nullptr)) {}
  ~QuietWarnings() { g_log_set_default_handler(before_, nullptr); }
  QuietWarnings(const QuietWarnings&) = delete;
  QuietWarnings& operator=(const QuietWarnings&) = delete;

 private:
  static void print_what_is_worse(const gchar* domain,
                                  GLogLevelFlags level,
                                  const gchar* text,
                                  gpointer data) {
    const bool is_worse = (level & (G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_ERROR)) != 0;
    if (is_worse && !is_refused_value(domain, text)) {
      g_log_default_handler(domain, level, text, data);
    }
  }

  GLogFunc before_;
};

}  // namespace support
