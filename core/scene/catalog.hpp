#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <span>

#include "core/scene/scene.hpp"

namespace ellipse {

/// A scene that has a name.
struct NamedScene {
  const char* name;
  const char* description;
  Scene (*make)(std::uint64_t seed);
};

/// All of them. Their order and their content are fixed: figures depend on them.
[[nodiscard]] std::span<const NamedScene> scene_catalog();

/// Throws std::invalid_argument that lists the names, where this is none of them.
[[nodiscard]] Scene scene_by_name(const char* name, std::uint64_t seed = 1);

/// A lens that has a name.
struct NamedLens {
  const char* name;
  const char* description;
  void (*put_on)(Scene& scene);  ///< Also makes of the flight one for its field of view.
};

/// All of them; their order and their content are fixed.
[[nodiscard]] std::span<const NamedLens> lens_catalog();

/// Throws std::invalid_argument that lists the names, where this is none of them.
void put_on_lens(Scene& scene, const char* name);

/// The nicks of the enumerations, in their order.
[[nodiscard]] std::span<const char* const> pattern_nicks();
[[nodiscard]] std::span<const char* const> ground_nicks();

}  // namespace ellipse
