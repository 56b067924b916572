// SPDX-License-Identifier: MIT
#include "core/scene/sensor.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/random.hpp"

namespace ellipse {
namespace {

using Block = Eigen::Matrix<float, 8, 8>;

// The sum of four uniform bytes, nearly normal, scaled to standard deviation 1 (from 147.8).
float nearly_normal(std::uint32_t bits) {
  const std::uint32_t pairs = (bits & 0x00ff00ffU) + ((bits >> 8U) & 0x00ff00ffU);
  const auto sum = static_cast<int>((pairs & 0xffffU) + (pairs >> 16U));
  return static_cast<float>(sum - 510) * (1.0F / 147.8F);
}

// [T.81] table K.1.
constexpr std::array<int, 64> kLumaQuantization = {
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,  //
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,  //
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,  //
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99,
};

Block quantization(int quality) {
  // The scale of libjpeg's quality.
  const int percent = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  Block steps;
  for (int i = 0; i < 64; ++i) {
    const int step = (kLumaQuantization[static_cast<std::size_t>(i)] * percent + 50) / 100;
    steps(i / 8, i % 8) = static_cast<float>(std::clamp(step, 1, 255));
  }
  return steps;
}

// [T.81] A.3.3: the orthonormal cosine transform.
Block cosine_transform() {
  Block transform;
  for (int u = 0; u < 8; ++u) {
    const double scale = u == 0 ? std::sqrt(0.125) : 0.5;
    for (int x = 0; x < 8; ++x) {
      transform(u, x) =
          static_cast<float>(scale * std::cos((2 * x + 1) * u * std::numbers::pi / 16.0));
    }
  }
  return transform;
}

// Eigen's product fuses multiplication and addition where the processor can, which rounds
// otherwise.
Block product(const Block& a, const Block& b) {
  Block result;
  for (int column = 0; column < 8; ++column) {
    for (int row = 0; row < 8; ++row) {
      float sum = a(row, 0) * b(0, column);
      for (int k = 1; k < 8; ++k) sum += a(row, k) * b(k, column);
      result(row, column) = sum;
    }
  }
  return result;
}

// Blocks beyond the border repeat its last pixel.
Block load(const MutableImage& picture, int left, int top) {
  Block block;
  for (int y = 0; y < 8; ++y) {
    const std::uint8_t* row = picture.data + std::min(top + y, picture.height - 1) * picture.stride;
    for (int x = 0; x < 8; ++x) {
      block(y, x) = static_cast<float>(row[std::min(left + x, picture.width - 1)]) - 128.0F;
    }
  }
  return block;
}

void store(const Block& block, const MutableImage& picture, int left, int top) {
  for (int y = 0; y < std::min(8, picture.height - top); ++y) {
    std::uint8_t* row = picture.data + (top + y) * picture.stride;
    for (int x = 0; x < std::min(8, picture.width - left); ++x) {
      row[left + x] = static_cast<std::uint8_t>(std::clamp(block(y, x) + 128.5F, 0.0F, 255.0F));
    }
  }
}

}  // namespace

SensorReader::SensorReader(const Sensor& sensor) : sensor_(sensor) {
  const double read_variance = sensor.read_noise * sensor.read_noise;
  for (std::size_t level = 0; level < noise_at_level_.size(); ++level) {
    const double variance = read_variance + sensor.shot_noise * static_cast<double>(level);
    noise_at_level_[level] = static_cast<float>(std::sqrt(variance));
    developed_at_level_[level] =
        static_cast<float>(255.0 * std::pow(static_cast<double>(level) / 255.0, sensor.gamma));
  }
}

float SensorReader::developed(float level) const {
  if (sensor_.gamma == 1.0) return level;
  const float clamped = std::clamp(level, 0.0F, 255.0F);
  const auto index = static_cast<std::size_t>(clamped);
  return std::lerp(developed_at_level_[index],
                   developed_at_level_[index + 1],
                   clamped - static_cast<float>(index));
}

void SensorReader::read(std::span<const float> light,
                        std::uint64_t seed,
                        const MutableImage& picture) const {
  const auto gain = static_cast<float>(sensor_.gain);
  const auto bias = static_cast<float>(sensor_.bias);
  const bool has_noise = noise_at_level_.back() > 0.0F;
  const float* from = light.data();
  std::uint64_t pair = seed;  // of pixels: one hash serves two
  for (int y = 0; y < picture.height; ++y) {
    std::uint8_t* row = picture.data + y * picture.stride;
    for (int x = 0; x < picture.width; x += 2) {
      const std::uint64_t bits = has_noise ? hash(pair++) : 0U;
      for (int i = 0; i < std::min(2, picture.width - x); ++i) {
        float level = developed(gain * *from++) + bias;
        if (has_noise) {
          const auto index = static_cast<std::size_t>(std::clamp(level - bias, 0.0F, 256.0F));
          level += noise_at_level_[index] *
                   nearly_normal(static_cast<std::uint32_t>(i == 0 ? bits : bits >> 32U));
        }
        row[x + i] = static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
      }
    }
  }
  if (sensor_.jpeg_quality > 0) compress_jpeg(picture, sensor_.jpeg_quality);
}

void compress_jpeg(const MutableImage& picture, int quality) {
  static const Block kTransform = cosine_transform();
  static const Block kInverse = kTransform.transpose();
  const Block steps = quantization(std::clamp(quality, 1, 100));
  for (int top = 0; top < picture.height; top += 8) {
    for (int left = 0; left < picture.width; left += 8) {
      const Block pixels = load(picture, left, top);
      const Block frequencies = product(product(kTransform, pixels), kInverse);
      const Block kept = (frequencies.array() / steps.array()).round() * steps.array();
      store(product(product(kInverse, kept), kTransform), picture, left, top);
    }
  }
}

}  // namespace ellipse
