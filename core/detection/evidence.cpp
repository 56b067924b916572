// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/text_file.hpp"

namespace ellipse {
namespace {

constexpr std::array<FeatureInfo, kFeatures> kInfos = {{
    {"turn-support", "share of the outline's turn that has edges"},
    {"direction-error", "median angle between gradient and normal"},
    {"coverage", "turn support, reduced by gaps and by the part outside"},
    {"length", "length inside the picture"},
    {"deviation", "distance of the edges from the ellipse"},
    {"changes", "changes of polarity per edge"},
    {"contrast", "gradient over noise"},
    {"corners", "turn gathered in evenly spaced corners"},
}};
constexpr const char* kBias = "bias";

std::invalid_argument error_at(const std::filesystem::path& file,
                               int line,
                               const std::string& text) {
  return std::invalid_argument(file.string() + ":" + std::to_string(line) + ": " + text);
}

double number_in(std::istream& words, const std::filesystem::path& file, int line) {
  std::string text = "the end of the line";
  words >> text;
  std::istringstream in(text);
  double value = 0.0;
  if (!(in >> value) || !in.eof() || !std::isfinite(value)) {
    throw error_at(file, line, "expected a number, not " + text);
  }
  return value;
}

}  // namespace

std::span<const FeatureInfo, kFeatures> feature_infos() {
  return kInfos;
}

Features EvidenceTable::contributions(const Features& features) const {
  Features result;
  for (std::size_t i = 0; i < kFeatures; ++i) result[i] = weights[i] * (features[i] - means[i]);
  return result;
}

double EvidenceTable::log_odds(const Features& features) const {
  double sum = bias;
  for (const double each : contributions(features)) sum += each;
  return sum;
}

double EvidenceTable::probability(const Features& features) const {
  return probability_of(log_odds(features));
}

EvidenceTable read_evidence(const std::filesystem::path& file) {
  std::istringstream in(read_text_file(file.string()));
  EvidenceTable table;
  std::array<bool, kFeatures + 1> is_known{};
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    std::istringstream words(text.substr(0, text.find('#')));
    std::string name;
    if (!(words >> name)) continue;
    std::size_t i = 0;
    while (i < kFeatures && name != kInfos[i].nick) ++i;
    if (i == kFeatures && name != kBias) {
      throw error_at(file, line, "is not an evidence table: unknown feature \"" + name + "\"");
    }
    if (is_known[i]) throw error_at(file, line, "duplicate entry " + name);
    is_known[i] = true;
    double& first = i == kFeatures ? table.bias : table.weights[i];
    first = number_in(words, file, line);
    if (i < kFeatures) table.means[i] = number_in(words, file, line);
    if (words >> name) throw error_at(file, line, "unexpected " + name);
  }
  for (std::size_t i = 0; i <= kFeatures; ++i) {
    const std::string name = i == kFeatures ? kBias : kInfos[i].nick;
    if (!is_known[i]) throw std::invalid_argument(file.string() + ": " + name + " is missing");
  }
  return table;
}

void write_evidence(std::ostream& out, const EvidenceTable& table) {
  out << std::setprecision(6);
  for (std::size_t i = 0; i < kFeatures; ++i) {
    out << kInfos[i].nick << ' ' << table.weights[i] << ' ' << table.means[i] << "  # "
        << kInfos[i].description << '\n';
  }
  out << kBias << ' ' << table.bias << '\n';
}

}  // namespace ellipse
