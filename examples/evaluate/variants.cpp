// SPDX-License-Identifier: MIT
#include "examples/evaluate/variants.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace evaluate {
namespace {

// Where a pixel moves: p -> linear p + shift [px].
struct Motion {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

struct Variant {
  const char* name;
  const char* description;
  // @param picture  8-bit grey.
  cv::Mat (*alter)(const cv::Mat& picture, cv::RNG& random);
  // nullptr if pixels stay in place.
  Motion (*motion)(cv::Size size) = nullptr;
  bool depends_on_size = false;
};

cv::Mat with_noise(const cv::Mat& picture, double gain, double sigma, cv::RNG& random) {
  cv::Mat noise(picture.size(), CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  cv::Mat levels;
  picture.convertTo(levels, CV_32F, gain);
  cv::Mat result;
  cv::Mat(levels + noise).convertTo(result, CV_8U);  // rounds and saturates
  return result;
}

cv::Mat blurred(const cv::Mat& picture, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(picture, result, {}, sigma_px);
  return result;
}

cv::Mat flipped(const cv::Mat& picture, int code) {
  cv::Mat result;
  cv::flip(picture, result, code);
  return result;
}

cv::Mat resized(const cv::Mat& picture, double factor) {
  cv::Mat result;
  const int method = factor < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC;
  cv::resize(picture, result, {}, factor, factor, method);
  return result;
}

Motion scaling(double factor) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
  return {factor * Eigen::Matrix2d::Identity(), factor * half - half};
}

const std::array<Variant, 13> kVariants = {{
    {"flip-x",
     "mirrored left to right",
     [](const cv::Mat& picture, cv::RNG&) { return flipped(picture, 1); },
     [](cv::Size size) {
       return Motion{Eigen::Vector2d(-1.0, 1.0).asDiagonal(), {size.width - 1.0, 0.0}};
     },
     true},
    {"flip-y",
     "mirrored top to bottom",
     [](const cv::Mat& picture, cv::RNG&) { return flipped(picture, 0); },
     [](cv::Size size) {
       return Motion{Eigen::Vector2d(1.0, -1.0).asDiagonal(), {0.0, size.height - 1.0}};
     },
     true},
    {"rotate",
     "rotated by 90 degrees, clockwise",
     [](const cv::Mat& picture, cv::RNG&) {
       cv::Mat result;
       cv::rotate(picture, result, cv::ROTATE_90_CLOCKWISE);
       return result;
     },
     [](cv::Size size) {
       Motion motion;
       motion.linear << 0.0, -1.0, 1.0, 0.0;
       motion.shift = {size.height - 1.0, 0.0};
       return motion;
     },
     true},
    {"shrink",
     "three quarters of the size",
     [](const cv::Mat& picture, cv::RNG&) { return resized(picture, 0.75); },
     [](cv::Size) { return scaling(0.75); }},
    {"third",
     "a third of the size",
     [](const cv::Mat& picture, cv::RNG&) { return resized(picture, 1.0 / 3.0); },
     [](cv::Size) { return scaling(1.0 / 3.0); }},
    {"enlarge",
     "three times the size, noise of 6",
     [](const cv::Mat& picture, cv::RNG& random) {
       return with_noise(resized(picture, 3.0), 1.0, 6.0, random);
     },
     [](cv::Size) { return scaling(3.0); }},
    {"blur",
     "blur of 1.2 px, noise of 1",
     [](const cv::Mat& picture, cv::RNG& random) {
       return with_noise(blurred(picture, 1.2), 1.0, 1.0, random);
     }},
    {"defocus",
     "blur of 3 px, noise of 2",
     [](const cv::Mat& picture, cv::RNG& random) {
       return with_noise(blurred(picture, 3.0), 1.0, 2.0, random);
     }},
    {"motion",
     "motion blur of 9 px along the diagonal",
     [](const cv::Mat& picture, cv::RNG&) {
       cv::Mat result;
       cv::filter2D(picture, result, -1, cv::Mat::eye(9, 9, CV_32F) / 9.0);
       return result;
     }},
    {"noise",
     "noise of 6 grey levels",
     [](const cv::Mat& picture, cv::RNG& random) { return with_noise(picture, 1.0, 6.0, random); }},
    {"grain",
     "noise of 20 grey levels",
     [](const cv::Mat& picture, cv::RNG& random) {
       return with_noise(picture, 1.0, 20.0, random);
     }},
    {"dark",
     ".13 of the light, noise of 1.5",
     [](const cv::Mat& picture, cv::RNG& random) {
       return with_noise(picture, 0.13, 1.5, random);
     }},
    {"jpeg",
     "JPEG of quality 12",
     [](const cv::Mat& picture, cv::RNG&) {
       std::vector<unsigned char> file;
       cv::imencode(".jpg", picture, file, {cv::IMWRITE_JPEG_QUALITY, 12});
       return cv::imdecode(file, cv::IMREAD_GRAYSCALE);
     }},
}};

const Variant& variant_by_name(const std::string& name) {
  const auto found = std::find_if(kVariants.begin(), kVariants.end(), [&](const Variant& variant) {
    return variant.name == name;
  });
  if (found != kVariants.end()) return *found;
  std::string message = "--variants " + name + ": unknown; known are";
  for (const std::string& known : variant_names()) message += " " + known;
  throw std::invalid_argument(message);
}

class AlteredPictures : public PictureSource {
 public:
  AlteredPictures(const Sequence& original, const Variant& variant)
      : originals_(original.frames), pictures_(original.pictures), alter_(variant.alter) {}

  [[nodiscard]] cv::Mat picture(const Frame& frame) override {
    cv::RNG random(frame.number + 1);  // 0 is no seed
    return alter_(pictures_->picture(originals_.at(frame.number)), random);
  }

 private:
  std::vector<Frame> originals_;
  std::shared_ptr<PictureSource> pictures_;
  cv::Mat (*alter_)(const cv::Mat& picture, cv::RNG& random);
};

void move(ellipse::Ellipse& e, const Motion& motion) {
  e = ellipse::transformed(e, motion.linear, motion.shift).value();
}

void move(Truth& truth, const Motion& motion) {
  if (truth.target) move(*truth.target, motion);
  for (TrueEllipse& other : truth.others) move(other.ellipse, motion);
}

// An unreadable picture is reported when it is evaluated.
cv::Size size_of(const Sequence& sequence, const Frame& frame) {
  try {
    return sequence.pictures->picture(frame).size();
  } catch (const std::runtime_error&) {
    return {};
  }
}

Sequence altered(const Sequence& original, const Variant& variant) {
  Sequence copy = original;
  copy.dataset += std::string(" ") + variant.name;
  copy.pictures = std::make_shared<AlteredPictures>(original, variant);
  for (std::size_t i = 0; i < copy.frames.size(); ++i) {
    Frame& frame = copy.frames[i];
    frame.image.clear();
    frame.number = i;
    if (variant.motion == nullptr) continue;
    const cv::Size size =
        variant.depends_on_size ? size_of(original, original.frames[i]) : cv::Size();
    move(frame.truth, variant.motion(size));
  }
  return copy;
}

}  // namespace

std::vector<std::string> variant_names() {
  std::vector<std::string> names;
  for (const Variant& variant : kVariants) names.emplace_back(variant.name);
  return names;
}

std::string describe_variants() {
  std::string text;
  for (const Variant& variant : kVariants) {
    text += std::string(text.empty() ? "" : "; ") + variant.name + " = " + variant.description;
  }
  return text;
}

std::vector<Sequence> variants_of(const std::vector<Sequence>& sequences,
                                  const std::vector<std::string>& names) {
  std::vector<Sequence> copies;
  for (const std::string& name : names) {
    const Variant& variant = variant_by_name(name);
    for (const Sequence& sequence : sequences) {
      if (variant.motion != nullptr && sequence.distortion) {
        throw std::invalid_argument("--variants " + name + ": " + sequence.dataset + ", " +
                                    sequence.name +
                                    " has a distorting lens, so its pixels cannot be moved");
      }
      copies.push_back(altered(sequence, variant));
    }
  }
  return copies;
}

}  // namespace evaluate
