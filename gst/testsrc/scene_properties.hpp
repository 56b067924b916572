#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include "core/scene/scene.hpp"

/// Size and frame rate of a scene.
struct SceneFormat {
  gint width = 640;
  gint height = 360;
  gint rate_n = 30;
  gint rate_d = 1;
};

/// The scene that the properties of ellipsetestsrc select. A value type.
struct SceneProperties {
  static constexpr gint kAsTheScene = -1;  ///< For pattern, ground and noise.
  static constexpr gint kNoLens = 0;       ///< Higher values are the lenses of the catalog.

  gint scene = 0;  ///< Index in the catalog; the next one is the random scene.
  gint pattern = kAsTheScene;
  gint ground = kAsTheScene;
  gint lens = kNoLens;
  gdouble noise = kAsTheScene;  ///< Standard deviation [grey levels].
  guint seed = 1;

  /// Installs the properties with ids from first_id on.
  static void install(GObjectClass* object_class, guint first_id);
  static constexpr guint kCount = 6;

  /// @param which  The property's id minus first_id, below kCount.
  void set(guint which, const GValue* value);
  void get(guint which, GValue* value) const;

  [[nodiscard]] ellipse::Scene make() const;
  /// Used if downstream leaves them open; a random scene has its own.
  [[nodiscard]] SceneFormat preferred_format() const;
};
