#include "harmless.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string>

namespace kaboum::verify {
namespace {

/// In the order of the alphabet.
constexpr std::array kHarmless = std::to_array<std::string_view>({
    "ACTION",
    "ACTION_ASSIGNMENT",
    "ACTION_METHOD",
    "ACTION_REQUEST_ASSIGNMENT",
    "ADDRESS",
    "ANNOTATION_CURVE_OCCURRENCE",
    "ANNOTATION_FILL_AREA",
    "ANNOTATION_FILL_AREA_OCCURRENCE",
    "ANNOTATION_OCCURRENCE",
    "ANNOTATION_PLANE",
    "ANNOTATION_SYMBOL_OCCURRENCE",
    "ANNOTATION_TEXT_OCCURRENCE",
    "APPLICATION_CONTEXT",
    "APPLICATION_CONTEXT_ELEMENT",
    "APPLICATION_PROTOCOL_DEFINITION",
    "APPLIED_ACTION_ASSIGNMENT",
    "APPLIED_APPROVAL_ASSIGNMENT",
    "APPLIED_DATE_AND_TIME_ASSIGNMENT",
    "APPLIED_DATE_ASSIGNMENT",
    "APPLIED_DOCUMENT_REFERENCE",
    "APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT",
    "APPLIED_GROUP_ASSIGNMENT",
    "APPLIED_IDENTIFICATION_ASSIGNMENT",
    "APPLIED_ORGANIZATION_ASSIGNMENT",
    "APPLIED_PERSON_AND_ORGANIZATION_ASSIGNMENT",
    "APPLIED_SECURITY_CLASSIFICATION_ASSIGNMENT",
    "APPROVAL",
    "APPROVAL_ASSIGNMENT",
    "APPROVAL_DATE_TIME",
    "APPROVAL_PERSON_ORGANIZATION",
    "APPROVAL_RELATIONSHIP",
    "APPROVAL_ROLE",
    "APPROVAL_STATUS",
    "CALENDAR_DATE",
    "CAMERA_IMAGE",
    "CAMERA_MODEL",
    "CAMERA_MODEL_D2",
    "CAMERA_MODEL_D3",
    "CAMERA_USAGE",
    "CC_DESIGN_APPROVAL",
    "CC_DESIGN_CERTIFICATION",
    "CC_DESIGN_CONTRACT",
    "CC_DESIGN_DATE_AND_TIME_ASSIGNMENT",
    "CC_DESIGN_PERSON_AND_ORGANIZATION_ASSIGNMENT",
    "CC_DESIGN_SECURITY_CLASSIFICATION",
    "CC_DESIGN_SPECIFICATION_REFERENCE",
    "CERTIFICATION",
    "CERTIFICATION_ASSIGNMENT",
    "CERTIFICATION_TYPE",
    "COLOUR",
    "COLOUR_RGB",
    "COLOUR_SPECIFICATION",
    "CONTRACT",
    "CONTRACT_ASSIGNMENT",
    "CONTRACT_TYPE",
    "COORDINATED_UNIVERSAL_TIME_OFFSET",
    "CURVE_STYLE",
    "CURVE_STYLE_FONT",
    "CURVE_STYLE_FONT_PATTERN",
    "DATE",
    "DATE_AND_TIME",
    "DATE_AND_TIME_ASSIGNMENT",
    "DATE_ASSIGNMENT",
    "DATE_ROLE",
    "DATE_TIME_ROLE",
    "DOCUMENT",
    "DOCUMENT_REFERENCE",
    "DOCUMENT_RELATIONSHIP",
    "DOCUMENT_TYPE",
    "DOCUMENT_USAGE_CONSTRAINT",
    "DRAUGHTING_CALLOUT",
    "DRAUGHTING_MODEL",
    "DRAUGHTING_PRE_DEFINED_COLOUR",
    "DRAUGHTING_PRE_DEFINED_CURVE_FONT",
    "DRAUGHTING_PRE_DEFINED_TEXT_FONT",
    "EXTERNALLY_DEFINED_CURVE_FONT",
    "EXTERNALLY_DEFINED_TEXT_FONT",
    "FILL_AREA_STYLE",
    "FILL_AREA_STYLE_COLOUR",
    "FILL_AREA_STYLE_HATCHING",
    "FILL_AREA_STYLE_TILES",
    "GROUP",
    "GROUP_ASSIGNMENT",
    "IDENTIFICATION_ASSIGNMENT",
    "IDENTIFICATION_ROLE",
    "INVISIBILITY",
    "LOCAL_TIME",
    "MATERIAL_DESIGNATION",
    "MATERIAL_PROPERTY",
    "MECHANICAL_CONTEXT",
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_AREA",
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION",
    "ORGANIZATION",
    "ORGANIZATIONAL_ADDRESS",
    "ORGANIZATION_ASSIGNMENT",
    "ORGANIZATION_ROLE",
    "OVER_RIDING_STYLED_ITEM",
    "PERSON",
    "PERSONAL_ADDRESS",
    "PERSON_AND_ORGANIZATION",
    "PERSON_AND_ORGANIZATION_ASSIGNMENT",
    "PERSON_AND_ORGANIZATION_ROLE",
    "POINT_STYLE",
    "PRESENTATION_AREA",
    "PRESENTATION_LAYER_ASSIGNMENT",
    "PRESENTATION_LAYER_USAGE",
    "PRESENTATION_REPRESENTATION",
    "PRESENTATION_SET",
    "PRESENTATION_SIZE",
    "PRESENTATION_STYLE_ASSIGNMENT",
    "PRESENTATION_STYLE_BY_CONTEXT",
    "PRESENTATION_VIEW",
    "PRE_DEFINED_COLOUR",
    "PRE_DEFINED_CURVE_FONT",
    "PRE_DEFINED_ITEM",
    "PRE_DEFINED_TEXT_FONT",
    "PRODUCT_CATEGORY",
    "PRODUCT_CATEGORY_RELATIONSHIP",
    "PRODUCT_RELATED_PRODUCT_CATEGORY",
    "SECURITY_CLASSIFICATION",
    "SECURITY_CLASSIFICATION_ASSIGNMENT",
    "SECURITY_CLASSIFICATION_LEVEL",
    "STYLED_ITEM",
    "SURFACE_RENDERING_PROPERTIES",
    "SURFACE_SIDE_STYLE",
    "SURFACE_STYLE_BOUNDARY",
    "SURFACE_STYLE_CONTROL_GRID",
    "SURFACE_STYLE_FILL_AREA",
    "SURFACE_STYLE_PARAMETER_LINE",
    "SURFACE_STYLE_REFLECTANCE_AMBIENT",
    "SURFACE_STYLE_REFLECTANCE_AMBIENT_DIFFUSE",
    "SURFACE_STYLE_REFLECTANCE_AMBIENT_DIFFUSE_SPECULAR",
    "SURFACE_STYLE_RENDERING",
    "SURFACE_STYLE_RENDERING_WITH_PROPERTIES",
    "SURFACE_STYLE_SEGMENTATION_CURVE",
    "SURFACE_STYLE_SILHOUETTE",
    "SURFACE_STYLE_TRANSPARENT",
    "SURFACE_STYLE_USAGE",
    "TEXT_LITERAL",
    "TEXT_STYLE",
    "TEXT_STYLE_FOR_DEFINED_FONT",
    "TEXT_STYLE_WITH_BOX_CHARACTERISTICS",
    "VIEW_VOLUME",
});
static_assert(std::is_sorted(kHarmless.begin(), kHarmless.end()));

bool is_harmless(std::string_view type) {
  return std::binary_search(kHarmless.begin(), kHarmless.end(), type);
}

/// The text without comments, and with nothing in its strings.
std::string bare(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '/' && i + 1 < text.size() && text[i + 1] == '*') {
      const std::size_t end = text.find("*/", i + 2);
      if (end == std::string_view::npos) break;
      i = end + 1;
    } else if (text[i] == '\'' || text[i] == '"') {
      const std::size_t end = text.find(text[i], i + 1);
      if (end == std::string_view::npos) break;
      i = end;
    } else if (std::isspace(static_cast<unsigned char>(text[i])) == 0) {
      out += text[i];
    }
  }
  return out;
}

/// Whether all types of "NAME(...)" or "(NAME(...)NAME(...))" are harmless.
bool are_harmless(std::string_view types) {
  const int level = types.starts_with('(') ? 1 : 0;
  int depth = 0;
  std::size_t begin = 0, count = 0;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] == '(') {
      if (depth == level && i > 0) {
        if (!is_harmless(types.substr(begin, i - begin))) return false;
        ++count;
      }
      ++depth;
      if (depth == level) begin = i + 1;
    } else if (types[i] == ')') {
      --depth;
      if (depth == level) begin = i + 1;
    }
  }
  return count > 0 && depth == 0;
}

}  // namespace

std::unordered_set<int> harmless_in_step(std::string_view text) {
  std::unordered_set<int> out;
  const std::string all = bare(text);
  std::string_view rest = all;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    const std::string_view statement = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t equals = statement.find('=');
    if (!statement.starts_with('#') || equals == std::string_view::npos) continue;
    const int number = std::atoi(std::string(statement.substr(1, equals - 1)).c_str());
    if (are_harmless(statement.substr(equals + 1))) out.insert(number);
  }
  return out;
}

bool harmless_in_iges(int type) {
  switch (type) {
    case 0:    // null
    case 202:  // dimensions, notes, labels and symbols
    case 204:
    case 206:
    case 208:
    case 210:
    case 212:
    case 213:
    case 214:
    case 216:
    case 218:
    case 220:
    case 222:
    case 228:
    case 230:
    case 304:  // fonts and colours
    case 310:
    case 312:
    case 314:
    case 404:  // drawings, properties, views
    case 406:
    case 410:
      return true;
    default:
      return false;
  }
}

}  // namespace kaboum::verify
