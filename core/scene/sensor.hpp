#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ellipse {

/// An 8-bit picture to be written.
struct MutableImage {
  std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< From row to row [bytes].
};

/// Properties of a camera's sensor and its image processing.
struct Sensor {
  double gain = 1.0;        ///< Grey levels per unit of light; 0.14 is dusk.
  double bias = 0.0;        ///< Grey levels without light.
  double read_noise = 2.0;  ///< Standard deviation [grey levels].
  double shot_noise = 0.0;  ///< Variance per grey level of light [grey levels].
  double blur_px = 0.6;     ///< Standard deviation of the lens's blur; above 0.
  double exposure_s = 0.0;  ///< Causes motion blur; 0 = an instant.
  double readout_s = 0.0;   ///< Time from the first row to the last; 0 = global shutter.
  double field_s = 0.0;     ///< Delay of the odd rows after the even ones; 0 = progressive.
  double gamma = 1.0;       ///< Exponent of the grey levels; 255 stays 255.
  int jpeg_quality = 0;     ///< 1 to 100: quality of JPEG compression; 0 = none.
};

/// Converts light to grey levels. Holds only tables of the gamma curve and of the noise.
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

/// Applies the loss of JPEG compression to the luma: rounds the cosine coefficients of 8 x 8 blocks
/// to multiples of [T.81] table K.1. Creates no file.
/// @param quality  1 to 100, as in libjpeg.
void compress_jpeg(const MutableImage& picture, int quality);

}  // namespace ellipse
