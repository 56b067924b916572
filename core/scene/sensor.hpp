#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ellipse {

/// An 8-bit picture to be written.
struct MutableImage {
  std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< From row to row [bytes].
};

/// What a camera makes of the light that its lens lets in.
struct Sensor {
  double gain = 1.0;        ///< Grey levels per unit of light; 0.14 is dusk.
  double bias = 0.0;        ///< Grey levels without light.
  double read_noise = 2.0;  ///< Standard deviation [grey levels].
  double shot_noise = 0.0;  ///< Variance per grey level of light [grey levels].
  double blur_px = 0.6;     ///< Standard deviation of the lens's blur; above 0.
  double exposure_s = 0.0;  ///< Everything that moves in this time is blurred; 0 = an instant.
  double readout_s = 0.0;   ///< From the first row's time to the last one's; 0 = all at once.
  double field_s = 0.0;     ///< The odd rows are so much later than the even ones; 0 = progressive.
  double gamma = 1.0;       ///< Exponent of the grey levels, of which 255 stays 255.
  int jpeg_quality = 0;     ///< 1 to 100: as JPEG leaves it at this quality; 0 = no compression.
};

/// Turns light into grey levels. Keeps a table of the noise and no more.
class SensorReader {
 public:
  explicit SensorReader(const Sensor& sensor);

  /// @param light  Row by row, width x height.
  /// @param seed   Of this frame's noise.
  /// Allocates nothing.
  void read(std::span<const float> light, std::uint64_t seed, const MutableImage& picture) const;

 private:
  [[nodiscard]] float developed(float level) const;

  Sensor sensor_;
  std::array<float, 257> developed_at_level_{};
  std::array<float, 257> noise_at_level_{};
};

/// Replaces a picture by what is left of it after JPEG compression of its luma: the cosine
/// coefficients of 8 x 8 blocks, rounded to multiples of [T.81] table K.1. No file is made.
/// @param quality  1 to 100, as libjpeg counts.
void compress_jpeg(const MutableImage& picture, int quality);

}  // namespace ellipse
