#pragma once

#include <array>
#include <string_view>

#include "names.h"

// Names of nodes and fields of VRML 97 (ISO/IEC 14772-1) and X3D (ISO/IEC 19775-1) that are known.
namespace kaboum::io {

inline constexpr std::array<std::string_view, 10> kGroups = {
    "Anchor",    "CADAssembly", "CADFace",       "CADLayer",    "CADPart",
    "Collision", "Group",       "PickableGroup", "StaticGroup", "Transform"};
/// Nodes between shapes that hold none; parts of shapes stand there when they are kept for USE.
inline constexpr std::array<std::string_view, 83> kHarmless = {"Appearance",
                                                               "AudioClip",
                                                               "Background",
                                                               "BooleanFilter",
                                                               "BooleanSequencer",
                                                               "BooleanToggle",
                                                               "BooleanTrigger",
                                                               "CollisionSensor",
                                                               "Color",
                                                               "ColorChaser",
                                                               "ColorDamper",
                                                               "ColorInterpolator",
                                                               "ColorRGBA",
                                                               "Coordinate",
                                                               "CoordinateChaser",
                                                               "CoordinateDamper",
                                                               "CoordinateDouble",
                                                               "CoordinateInterpolator",
                                                               "CoordinateInterpolator2D",
                                                               "CylinderSensor",
                                                               "DirectionalLight",
                                                               "EaseInEaseOut",
                                                               "EnvironmentLight",
                                                               "Fog",
                                                               "FontStyle",
                                                               "ImageTexture",
                                                               "IntegerSequencer",
                                                               "IntegerTrigger",
                                                               "KeySensor",
                                                               "LinePickSensor",
                                                               "LoadSensor",
                                                               "LocalFog",
                                                               "Material",
                                                               "MetadataBoolean",
                                                               "MetadataDouble",
                                                               "MetadataFloat",
                                                               "MetadataInteger",
                                                               "MetadataSet",
                                                               "MetadataString",
                                                               "MovieTexture",
                                                               "NavigationInfo",
                                                               "Normal",
                                                               "NormalInterpolator",
                                                               "OrientationChaser",
                                                               "OrientationDamper",
                                                               "OrientationInterpolator",
                                                               "OrthoViewpoint",
                                                               "PixelTexture",
                                                               "PlaneSensor",
                                                               "PointLight",
                                                               "PointPickSensor",
                                                               "PositionChaser",
                                                               "PositionChaser2D",
                                                               "PositionDamper",
                                                               "PositionDamper2D",
                                                               "PositionInterpolator",
                                                               "PositionInterpolator2D",
                                                               "PrimitivePickSensor",
                                                               "ProximitySensor",
                                                               "ScalarChaser",
                                                               "ScalarDamper",
                                                               "ScalarInterpolator",
                                                               "Script",
                                                               "Sound",
                                                               "SphereSensor",
                                                               "SplinePositionInterpolator",
                                                               "SplinePositionInterpolator2D",
                                                               "SplineScalarInterpolator",
                                                               "SpotLight",
                                                               "SquadOrientationInterpolator",
                                                               "StringSensor",
                                                               "TexCoordDamper2D",
                                                               "TextureBackground",
                                                               "TextureCoordinate",
                                                               "TextureTransform",
                                                               "TimeSensor",
                                                               "TimeTrigger",
                                                               "TouchSensor",
                                                               "TransformSensor",
                                                               "Viewpoint",
                                                               "VisibilitySensor",
                                                               "VolumePickSensor",
                                                               "WorldInfo"};

/// Fields of grouping nodes and shapes that neither hold nor move a surface.
inline constexpr std::array<std::string_view, 14> kGroupFields = {
    "bboxCenter", "bboxDisplay", "bboxSize",   "castShadow", "collide",  "description", "enabled",
    "load",       "name",        "objectType", "parameter",  "pickable", "range",       "url"};
inline constexpr std::array<std::string_view, 9> kSurfaces = {
    "IndexedFaceSet",          "IndexedQuadSet", "IndexedTriangleFanSet", "IndexedTriangleSet",
    "IndexedTriangleStripSet", "QuadSet",        "TriangleFanSet",        "TriangleSet",
    "TriangleStripSet"};
inline constexpr std::array<std::string_view, 16> kSurfaceFields = {
    "attrib",   "color",       "colorIndex",       "colorPerVertex",  "convex", "creaseAngle",
    "fogCoord", "normal",      "normalIndex",      "normalPerVertex", "solid",  "texCoord",
    "metadata", "bboxDisplay", "radianceTransfer", "texCoordIndex"};
/// Geometry without surface.
inline constexpr std::array<std::string_view, 8> kLines = {
    "Arc2D",      "Circle2D", "IndexedLineSet", "LineSet",
    "NurbsCurve", "PointSet", "Polyline2D",     "Polypoint2D"};

}  // namespace kaboum::io
