// SPDX-License-Identifier: MIT
//
// Generates the tables of properties in a document from the elements, between
//   <!-- properties of ELEMENT -->   and   <!-- end of properties -->
// and the matrix of the tracker's settings by detector and tracking, between
//   <!-- effects of settings -->   and   <!-- end of effects -->
// With --check it writes nothing, and fails if the document differs.
// The last column, the version that a property came with, is kept from the document; a new property
// gets the current version. Signals are written by hand, and checked.
#include <gst/base/gstbasetransform.h>
#include <gst/gst.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/tracking/setting_effect.hpp"
#include "gst/track/track_properties.hpp"

namespace {

constexpr char kBegin[] = "<!-- properties of ";
constexpr char kEnd[] = "<!-- end of properties -->";
constexpr char kEffectsBegin[] = "<!-- effects of settings -->";
constexpr char kEffectsEnd[] = "<!-- end of effects -->";
constexpr char kVersion[] = ELLIPSE_VERSION;  // major and minor

std::string in_backticks(const std::string& text) {
  return "`" + text + "`";
}

template <class Value>
std::string nicks_of(const Value* values, guint count) {
  std::string nicks;
  for (guint i = 0; i < count; ++i)
    nicks += (i > 0 ? ", " : "") + in_backticks(values[i].value_nick);
  return nicks;
}

std::string number(double value) {
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

std::string flags_of(const GValue& value) {
  const auto* type = static_cast<const GFlagsClass*>(g_type_class_peek(G_VALUE_TYPE(&value)));
  const guint set = g_value_get_flags(&value);
  std::string nicks;
  for (guint i = 0; i < type->n_values; ++i) {
    const GFlagsValue& flag = type->values[i];
    const bool is_set = flag.value == 0 ? set == 0 : (set & flag.value) == flag.value;
    if (!is_set) continue;
    if (!nicks.empty()) nicks += "+";
    nicks += flag.value_nick;
  }
  return in_backticks(nicks);
}

// Angle brackets would be taken for markup.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

template <class Spec>
std::string range_of(const char* type, const Spec* spec) {
  return std::string(type) + " " + number(static_cast<double>(spec->minimum)) + " - " +
         number(static_cast<double>(spec->maximum));
}

std::string type_of(GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_ENUM(spec)) {
    const GEnumClass* type = G_PARAM_SPEC_ENUM(spec)->enum_class;
    return "enum: " + nicks_of(type->values, type->n_values);
  }
  if (G_IS_PARAM_SPEC_FLAGS(spec)) {
    const GFlagsClass* type = G_PARAM_SPEC_FLAGS(spec)->flags_class;
    return "flags: " + nicks_of(type->values, type->n_values);
  }
  if (G_IS_PARAM_SPEC_DOUBLE(spec)) return range_of("double", G_PARAM_SPEC_DOUBLE(spec));
  if (G_IS_PARAM_SPEC_UINT(spec)) return range_of("uint", G_PARAM_SPEC_UINT(spec));
  if (G_IS_PARAM_SPEC_UINT64(spec)) return "uint64";
  if (G_IS_PARAM_SPEC_BOOLEAN(spec)) return "boolean";
  if (G_IS_PARAM_SPEC_STRING(spec)) return "string";
  if (GST_IS_PARAM_SPEC_ARRAY_LIST(spec)) {
    const GParamSpec* element = GST_PARAM_SPEC_ARRAY_LIST(spec)->element_spec;
    return std::string("`GstValueArray` of ") +
           (element->value_type == G_TYPE_DOUBLE ? "double" : "int");
  }
  if (spec->value_type == GST_TYPE_STRUCTURE) return "`GstStructure`";
  throw std::runtime_error(std::string("a property of a type without a name here: ") + spec->name);
}

// What a new element has, as people write it on a command line.
std::string default_of(GstElement* element, GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_BOXED(spec) || GST_IS_PARAM_SPEC_ARRAY_LIST(spec)) return "-";
  GValue value = G_VALUE_INIT;
  g_object_get_property(G_OBJECT(element), spec->name, &value);
  std::string text;
  if (G_VALUE_HOLDS_FLAGS(&value)) {
    text = flags_of(value);
  } else if (G_VALUE_HOLDS_UINT(&value) && g_str_has_suffix(spec->name, "-color")) {
    char hexadecimal[16];
    std::snprintf(hexadecimal, sizeof hexadecimal, "0x%08x", g_value_get_uint(&value));
    text = hexadecimal;
  } else if (G_VALUE_HOLDS_DOUBLE(&value)) {
    text = number(g_value_get_double(&value));
  } else if (G_VALUE_HOLDS_STRING(&value)) {
    const gchar* content = g_value_get_string(&value);
    text = content != nullptr && *content != '\0' ? content : "empty";
  } else {
    const std::unique_ptr<gchar, decltype(&g_free)> serialized(gst_value_serialize(&value), g_free);
    text = G_VALUE_HOLDS_ENUM(&value) ? in_backticks(serialized.get()) : serialized.get();
  }
  g_value_unset(&value);
  return text;
}

std::string changeable(const GParamSpec* spec) {
  if ((spec->flags & G_PARAM_WRITABLE) == 0) return "read only";
  if ((spec->flags & GST_PARAM_CONTROLLABLE) != 0) return "playing, C";
  if ((spec->flags & GST_PARAM_MUTABLE_PLAYING) != 0) return "playing";
  if ((spec->flags & GST_PARAM_MUTABLE_READY) != 0) return "ready";
  return "-";
}

// The last column of a row that begins with this name; empty where there is none.
std::string since_of(const std::string& name, const std::string& document) {
  const std::regex row("\\n\\| " + in_backticks(name) + " \\|.*\\| (\\d+\\.\\d+) \\|(?=\\n)");
  std::smatch found;
  return std::regex_search(document, found, row) ? found[1].str() : "";
}

// What stands about an element in the document, up to the next one.
std::string section_of(const std::string& element, const std::string& document) {
  const std::size_t begin = document.find("\n## " + element + "\n");
  if (begin == std::string::npos) throw std::runtime_error("no section ## " + element);
  const std::size_t end = document.find("\n## ", begin + 1);
  return document.substr(begin, end == std::string::npos ? end : end - begin);
}

void check_signals(GType type, const std::string& section) {
  guint count = 0;
  const std::unique_ptr<guint, decltype(&g_free)> ids(g_signal_list_ids(type, &count), g_free);
  for (guint i = 0; i < count; ++i) {
    const std::string name = g_signal_name(ids.get()[i]);
    if (since_of(name, section).empty()) {
      throw std::runtime_error("no version in the last column of the signal " + name);
    }
  }
}

// The table "Properties by purpose", each as "purpose: name".
std::vector<std::string> names_by_purpose(const std::string& section) {
  const std::size_t begin = section.find("\n### Properties by purpose\n");
  if (begin == std::string::npos) return {};
  const std::string part = section.substr(begin, section.find("\n### ", begin + 1) - begin);
  const std::regex row("\n\\|(?: \\[([a-z ]+)\\]\\([^|]*)?\\s*\\|([^|]*)\\|");
  const std::regex quoted("`([a-z-]+)`");
  std::vector<std::string> names;
  std::string purpose;
  for (std::sregex_iterator i(part.begin(), part.end(), row), end; i != end; ++i) {
    if ((*i)[1].matched) purpose = (*i)[1];
    const std::string cell = (*i)[2];
    for (std::sregex_iterator j(cell.begin(), cell.end(), quoted); j != end; ++j) {
      if ((*j)[1] != "qos") names.push_back(purpose + ": " + std::string((*j)[1]));
    }
  }
  return names;
}

// The properties by purpose must be those of the element, in its order. qos is the base class's.
void check_purposes(const std::vector<std::string>& own, const std::string& section) {
  const std::vector<std::string> names = names_by_purpose(section);
  if (names.empty()) return;
  const auto [expected, found] = std::mismatch(own.begin(), own.end(), names.begin(), names.end());
  if (expected == own.end() && found == names.end()) return;
  throw std::runtime_error("properties by purpose: " + (found == names.end() ? "nothing" : *found) +
                           " instead of " + (expected == own.end() ? "nothing" : *expected) +
                           ", see kPurposes in track_properties.cpp");
}

std::string table_of(const std::string& name, const std::string& document) {
  const std::unique_ptr<GstElement, decltype(&gst_object_unref)> element(
      gst_element_factory_make(name.c_str(), nullptr), gst_object_unref);
  if (!element) throw std::runtime_error("no element " + name);
  const std::string section = section_of(name, document);
  check_signals(G_OBJECT_TYPE(element.get()), section);
  std::string table =
      "| property | type, range | default | changeable | what it is | since |\n"
      "|---|---|---|---|---|---|\n";
  guint count = 0;
  const std::unique_ptr<GParamSpec*, decltype(&g_free)> specs(
      g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count), g_free);
  std::vector<std::string> own;
  for (guint i = 0; i < count; ++i) {
    GParamSpec* spec = specs.get()[i];
    const bool is_qos = spec->owner_type == GST_TYPE_BASE_TRANSFORM;
    if (spec->owner_type != G_OBJECT_TYPE(element.get()) && !is_qos) continue;
    if (!is_qos) own.push_back(std::string(purpose_of(spec)) + ": " + spec->name);
    const std::string since = since_of(spec->name, section);
    table += "| " + in_backticks(spec->name) + " | " + type_of(spec) + " | " +
             default_of(element.get(), spec) + " | " + changeable(spec) + " | " +
             escaped(g_param_spec_get_blurb(spec)) + " | " + (since.empty() ? kVersion : since) +
             " |\n";
  }
  check_purposes(own, section);
  return table;
}

std::string cell_of(const ellipse::SettingEffect& effect,
                    ellipse::DetectorKind detector,
                    ellipse::TrackingMode tracking) {
  switch (ellipse::acts_with(effect, detector, tracking)) {
    case ellipse::Acts::kAlways:
      return "yes";
    case ellipse::Acts::kAbove:
      return "above " + number(effect.elsewhere_above);
    case ellipse::Acts::kNever:
      break;
  }
  const std::string otherwise = effect.otherwise;
  return otherwise.empty() ? "-" : "with " + in_backticks(otherwise);
}

// Our detector and tracking first: they are the defaults.
constexpr ellipse::DetectorKind kDetectors[] = {ellipse::DetectorKind::kArcs,
                                                ellipse::DetectorKind::kContours};
constexpr ellipse::TrackingMode kTrackings[] = {
    ellipse::TrackingMode::kEdges, ellipse::TrackingMode::kRedetect, ellipse::TrackingMode::kNone};

void write_effects_of(const std::string& name, std::ostream& table) {
  const ellipse::SettingEffect effect = ellipse::effect_of(name);
  table << "| " << in_backticks(name) << " |";
  for (const auto detector : kDetectors) {
    for (const auto tracking : kTrackings) {
      table << ' ' << cell_of(effect, detector, tracking) << " |";
    }
  }
  table << '\n';
}

std::string effects_table() {
  std::ostringstream table;
  table << "| property |";
  for (const auto detector : kDetectors) {
    for (const auto tracking : kTrackings) {
      table << ' ' << in_backticks(ellipse::detector_nicks()[static_cast<std::size_t>(detector)])
            << ", " << in_backticks(ellipse::tracking_nicks()[static_cast<std::size_t>(tracking)])
            << " |";
    }
  }
  table << "\n|---|---|---|---|---|---|---|\n";
  for (const char* name : {"refine", "candidates"}) write_effects_of(name, table);
  for (const ellipse::SettingInfo& info : ellipse::setting_infos()) {
    write_effects_of(info.name, table);
  }
  return table.str();
}

// The table that belongs behind this line of the document; nullopt where none does.
std::optional<std::string> table_behind(const std::string& line, const std::string& document) {
  if (line == kEffectsBegin) return effects_table();
  if (line.rfind(kBegin, 0) != 0) return std::nullopt;
  const std::string name = line.substr(std::strlen(kBegin));
  return table_of(name.substr(0, name.find(' ')), document);
}

std::string with_tables(const std::string& document) {
  std::istringstream lines(document);
  std::string result;
  std::string line;
  bool is_in_table = false;
  while (std::getline(lines, line)) {
    if (line == kEnd || line == kEffectsEnd) is_in_table = false;
    if (!is_in_table) result += line + "\n";
    if (const auto table = table_behind(line, document)) {
      result += *table;
      is_in_table = true;
    }
  }
  if (is_in_table) throw std::runtime_error("a table without its end");
  return result;
}

int run(const std::string& file, bool is_check) {
  std::ifstream in(file);
  std::stringstream before;
  before << in.rdbuf();
  const std::string after = with_tables(before.str());
  if (after == before.str()) return 0;
  if (!is_check) {
    std::ofstream(file) << after;
    return 0;
  }
  std::fprintf(stderr,
               "%s is not what the elements say: run \"meson compile property-tables-update\"\n",
               file.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  const bool is_check = argc == 3 && std::strcmp(argv[1], "--check") == 0;
  if (argc != 2 && !is_check) {
    std::fputs("usage: property-tables [--check] FILE\n", stderr);
    return 2;
  }
  try {
    return run(argv[argc - 1], is_check);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
