#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <span>

#include "core/scene/scene.hpp"

namespace ellipse {

/// A named scene.
struct NamedScene {
  const char* name;
  const char* description;
  Scene (*make)(std::uint64_t seed);
};

/// All named scenes. Their order and content are fixed: published figures depend on them.
[[nodiscard]] std::span<const NamedScene> scene_catalog();

/// Throws std::invalid_argument that lists the names if there is no such scene.
[[nodiscard]] Scene scene_by_name(const char* name, std::uint64_t seed = 1);

/// A named lens.
struct NamedLens {
  const char* name;
  const char* description;
  void (*put_on)(Scene& scene);  ///< Also adapts the flight to its field of view.
};

/// All named lenses; their order and content are fixed.
[[nodiscard]] std::span<const NamedLens> lens_catalog();

/// Throws std::invalid_argument that lists the names if there is no such lens.
void put_on_lens(Scene& scene, const char* name);

/// Nicks of the enumerations, in their order.
[[nodiscard]] std::span<const char* const> pattern_nicks();
[[nodiscard]] std::span<const char* const> ground_nicks();

}  // namespace ellipse
