// The outer layers of glTF 2.0: GLB chunks, JSON, versions and extensions, buffers.

#include "gltf_file.h"

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "bytes.h"
#include "glb_chunks.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kGlbHeader = 12, kChunkHeader = 8;
constexpr int kMaxJsonDepth = 256;
constexpr std::uint64_t kMaxInteger = std::uint64_t{1} << 53U;

/// Extensions of looks, sound, light and names, wherever they stand. Names, not what they begin
/// with: what is invented may move a vertex. AGI_articulations moves nodes by its initial values.
constexpr std::array<std::string_view, 51> kHarmless = {"ADOBE_materials_clearcoat_specular",
                                                        "ADOBE_materials_clearcoat_tint",
                                                        "ADOBE_materials_thin_transparency",
                                                        "AGI_stk_metadata",
                                                        "CESIUM_primitive_outline",
                                                        "EXT_feature_metadata",
                                                        "EXT_instance_features",
                                                        "EXT_lights_ies",
                                                        "EXT_lights_image_based",
                                                        "EXT_mesh_features",
                                                        "EXT_mesh_manifold",
                                                        "EXT_structural_metadata",
                                                        "EXT_texture_avif",
                                                        "EXT_texture_webp",
                                                        "FB_geometry_metadata",
                                                        "FB_ngon_encoding",
                                                        "GODOT_single_root",
                                                        "KHR_animation_pointer",
                                                        "KHR_audio",
                                                        "KHR_audio_emitter",
                                                        "KHR_audio_graph",
                                                        "KHR_lights_environment",
                                                        "KHR_lights_punctual",
                                                        "KHR_materials_anisotropy",
                                                        "KHR_materials_clearcoat",
                                                        "KHR_materials_common",
                                                        "KHR_materials_diffuse_transmission",
                                                        "KHR_materials_dispersion",
                                                        "KHR_materials_emissive_strength",
                                                        "KHR_materials_ior",
                                                        "KHR_materials_iridescence",
                                                        "KHR_materials_pbrSpecularGlossiness",
                                                        "KHR_materials_sheen",
                                                        "KHR_materials_specular",
                                                        "KHR_materials_transmission",
                                                        "KHR_materials_unlit",
                                                        "KHR_materials_variants",
                                                        "KHR_materials_volume",
                                                        "KHR_node_hoverability",
                                                        "KHR_node_selectability",
                                                        "KHR_texture_basisu",
                                                        "KHR_texture_transform",
                                                        "KHR_xmp",
                                                        "KHR_xmp_json_ld",
                                                        "MSFT_audio_emitter",
                                                        "MSFT_lod",
                                                        "MSFT_packing_normalRoughnessMetallic",
                                                        "MSFT_packing_occlusionRoughnessMetallic",
                                                        "MSFT_texture_dds",
                                                        "NV_materials_mdl",
                                                        "VRMC_materials_mtoon"};
/// Extensions of geometry that the readers of accessors and nodes understand.
constexpr std::array<std::string_view, 2> kImplemented = {"EXT_mesh_gpu_instancing",
                                                          "KHR_mesh_quantization"};

bool harmless(std::string_view name) {
  return std::ranges::find(kHarmless, name) != kHarmless.end();
}

/// What to do about an extension that is not read.
std::string remedy(std::string_view name) {
  if (name == "KHR_draco_mesh_compression" || name.ends_with("_meshopt_compression"))
    return "decompress the file first: gltf-transform copy IN.glb OUT.glb";
  return "export the mesh without it";
}

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Without %XX; nullopt when they are not well formed.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hex(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex(text[i + 2]) : -1;
    if (high < 0 || low < 0 || high + low == 0) return std::nullopt;
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

/// nullopt when `text` is no base64 (RFC 4648, "=" at the end may be missing).
std::optional<std::vector<char>> base64_decoded(std::string_view text) {
  for (int i = 0; i < 2 && text.size() % 4 == 0 && text.ends_with('='); ++i) text.remove_suffix(1);
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<char> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int filled = 0;
  for (const char c : text) {
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      digit = static_cast<std::uint32_t>(c - 'a' + 26);
    } else if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0' + 52);
    } else if (c == '+') {
      digit = 62;
    } else if (c == '/') {
      digit = 63;
    } else {
      return std::nullopt;
    }
    bits = bits << 6U | digit;
    filled += 6;
    if (filled < 8) continue;
    filled -= 8;
    bytes.push_back(static_cast<char>(bits >> static_cast<unsigned>(filled) & 0xFFU));
  }
  return bytes;
}

}  // namespace

// --- JsonItem ---

void JsonItem::fail(const std::string& what) const {
  io::fail(*source_, (path_.empty() ? "the JSON part" : path_) + ": " + what);
}

bool JsonItem::has(const char* key) const {
  if (!json_->is_object()) fail("not an object; the file is damaged");
  return json_->contains(key);
}

JsonItem JsonItem::at(const char* key) const {
  if (!has(key)) fail(in_quotes(key) + " is missing; the file is damaged");
  return {*source_, (*json_)[key], path_.empty() ? key : path_ + "." + key};
}

JsonItem JsonItem::at(std::size_t index) const {
  return {*source_, (*json_)[index], path_ + "[" + std::to_string(index) + "]"};
}

std::size_t JsonItem::size() const {
  if (!json_->is_array()) fail("not an array; the file is damaged");
  return json_->size();
}

std::vector<std::string> JsonItem::keys() const {
  if (!json_->is_object()) fail("not an object; the file is damaged");
  std::vector<std::string> names;
  for (const auto& [key, value] : json_->items()) names.push_back(key);
  return names;
}

std::uint64_t JsonItem::integer() const {
  if (json_->is_number_unsigned() && json_->get<std::uint64_t>() <= kMaxInteger)
    return json_->get<std::uint64_t>();
  if (json_->is_number_float()) {
    const double x = json_->get<double>();
    if (x >= 0 && x <= static_cast<double>(kMaxInteger) && x == std::floor(x))
      return static_cast<std::uint64_t>(x);
  }
  fail("not an integer from 0 to 2^53; the file is damaged");
}

std::uint64_t JsonItem::integer_or(const char* key, std::uint64_t otherwise) const {
  return has(key) ? at(key).integer() : otherwise;
}

double JsonItem::number() const {
  if (!json_->is_number() || !std::isfinite(json_->get<double>()))
    fail("not a finite number; the file is damaged");
  return json_->get<double>();
}

std::vector<double> JsonItem::numbers(std::size_t count) const {
  if (size() != count) fail("not " + std::to_string(count) + " numbers; the file is damaged");
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(at(i).number());
  return values;
}

std::string JsonItem::text() const {
  if (!json_->is_string()) fail("not text; the file is damaged");
  return json_->get<std::string>();
}

bool JsonItem::truth() const {
  if (!json_->is_boolean()) fail("neither true nor false; the file is damaged");
  return json_->get<bool>();
}

// --- GltfFile ---

GltfFile::GltfFile(const Source& source) : source_(source), bytes_(source.bytes.size()) {
  if (source_.bytes.starts_with("glTF")) {
    source_.text = false;
    split_chunks();
  } else {
    parse(source_.bytes);
  }
  if (!json_.is_object()) io::fail(source_, "not a glTF file: its JSON is not an object");
  check_versions();
  check_required_extensions();
  check_extensions(root());
}

void GltfFile::split_chunks() {
  const std::string_view all = source_.bytes;
  if (all.size() < kGlbHeader + kChunkHeader)
    io::fail(source_, "not a GLB file: it is shorter than a header; get it again");
  const auto word = [&](std::size_t at) { return load_little<std::uint32_t>(all.data() + at); };
  if (word(4) != 2)
    io::fail(source_, all.data() + 4,
             "GLB version " + std::to_string(word(4)) + "; only version 2 can be read");
  const std::size_t size = word(8);
  if (size > all.size())
    io::fail(source_, all.data() + 8,
             "the header states " + std::to_string(size) + " bytes, but the file has " +
                 std::to_string(all.size()) + "; it is truncated, get it again");
  if (size < all.size())
    note(counted(all.size() - size, "byte", "bytes") + " after the stated end were ignored.");
  std::optional<std::string_view> json;
  std::size_t others = 0;
  for (std::size_t at = kGlbHeader; at < size;) {
    const std::size_t length = size - at < kChunkHeader ? size : word(at);
    if (size - at < kChunkHeader || length > size - at - kChunkHeader)
      io::fail(source_, all.data() + at,
               "a chunk is longer than the file; the file is damaged, get it again");
    const std::string_view chunk = all.substr(at + kChunkHeader, length);
    const std::uint32_t type = word(at + 4);
    std::optional<std::string_view>* const part = type == kJsonChunk     ? &json
                                                  : type == kBinaryChunk ? &binary_
                                                                         : nullptr;
    if (part != nullptr && part->has_value())
      io::fail(source_, all.data() + at,
               "a second chunk of the same kind; the file is damaged, export it again");
    if (part != nullptr) *part = chunk;
    others += part == nullptr ? 1 : 0;
    at += kChunkHeader + (length + 3) / 4 * 4;
  }
  if (!json) io::fail(source_, "the GLB file has no JSON chunk; it is damaged, get it again");
  if (others > 0)
    note(counted(others, "chunk of an unknown kind was", "chunks of unknown kinds were") +
         " ignored.");
  parse(*json);
}

/// Deep nesting and repeated keys, of which other programs may take another one, are refused.
void GltfFile::parse(std::string_view text) {
  using Event = JsonItem::Json::parse_event_t;
  std::vector<std::set<std::string>> keys;
  const auto look = [&](int depth, Event event, JsonItem::Json& value) {
    if (depth > kMaxJsonDepth)
      io::fail(source_, "its JSON is nested more than " + std::to_string(kMaxJsonDepth) +
                            " deep; the file is damaged");
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(value.get<std::string>()).second)
      io::fail(source_, "its JSON has the key " + in_quotes(value.get<std::string>()) +
                            " twice in one object; the file is damaged");
    return true;
  };
  try {
    json_ = JsonItem::Json::parse(text.begin(), text.end(), look);
  } catch (const JsonItem::Json::parse_error& e) {
    io::fail(source_, describe_json_damage(text, e.byte) +
                          "; it is damaged or not a glTF file, get or export it again");
  } catch (const JsonItem::Json::exception&) {
    io::fail(source_,
             "a number in its JSON is out of range; it is damaged, get or export it again");
  }
}

void GltfFile::check_versions() const {
  const JsonItem asset = root().at("asset");
  const std::string version = asset.at("version").text();
  if (!version.starts_with("2."))
    asset.fail("glTF version " + in_quotes(version) + "; only 2.0 can be read, convert the file");
  if (asset.has("minVersion") && asset.at("minVersion").text() != "2.0")
    asset.fail("the file needs a reader of glTF " + in_quotes(asset.at("minVersion").text()) +
               "; only 2.0 can be read, export it as 2.0");
}

void GltfFile::check_required_extensions() const {
  if (!root().has("extensionsRequired")) return;
  const JsonItem list = root().at("extensionsRequired");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = list.at(i).text();
    if (!harmless(name) && std::ranges::find(kImplemented, name) == kImplemented.end())
      io::fail(source_, "the file needs the glTF extension " + in_quotes(name) +
                            ", which cannot be read; " + remedy(name));
  }
}

void GltfFile::check_extensions(const JsonItem& object,
                                std::initializer_list<std::string_view> handled) const {
  if (!object.has("extensions")) return;
  for (const std::string& name : object.at("extensions").keys())
    if (!harmless(name) && std::ranges::find(handled, name) == handled.end())
      object.fail("the glTF extension " + in_quotes(name) +
                  " may hold geometry and cannot be read; " + remedy(name));
}

bool GltfFile::uses(std::string_view extension) const {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    if (!root().has(key)) continue;
    const JsonItem list = root().at(key);
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list.at(i).text() == extension) return true;
  }
  return false;
}

std::size_t GltfFile::count(const char* array) const {
  return root().has(array) ? root().at(array).size() : 0;
}

JsonItem GltfFile::element(const char* array, const JsonItem& index) const {
  const std::uint64_t i = index.integer();
  if (i >= count(array))
    index.fail("refers to number " + std::to_string(i) + " of " + std::to_string(count(array)) +
               " " + array + " (counted from 0); the file is damaged");
  return root().at(array).at(static_cast<std::size_t>(i));
}

std::string_view GltfFile::buffer(const JsonItem& index) {
  const JsonItem buffer = element("buffers", index);
  const auto known = buffers_.find(index.integer());
  if (known != buffers_.end()) return known->second;
  std::string_view bytes;
  if (buffer.has("uri")) {
    bytes = from_uri(buffer.at("uri"));
  } else if (index.integer() == 0 && binary_) {
    bytes = *binary_;
    const std::uint64_t stated = buffer.at("byteLength").integer();
    if (stated + 3 < bytes.size())
      note(counted(bytes.size() - stated, "byte", "bytes") +
           " of the binary part after its buffer were ignored.");
  } else {
    buffer.fail(
        "it has no data; decompress the file first (gltf-transform copy IN.glb OUT.glb), "
        "or export it again");
  }
  const std::uint64_t length = buffer.at("byteLength").integer();
  if (length > bytes.size())
    buffer.fail("it states " + std::to_string(length) + " bytes, but there are " +
                std::to_string(bytes.size()) + "; the data is truncated, get it again");
  return buffers_[index.integer()] = bytes.substr(0, static_cast<std::size_t>(length));
}

std::string_view GltfFile::from_uri(const JsonItem& uri) {
  const std::string text = uri.text();
  if (text.starts_with("data:")) {
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = text.find(kMark);
    if (mark == std::string::npos) uri.fail("a data URI without base64; export the file again");
    auto decoded = base64_decoded(std::string_view(text).substr(mark + kMark.size()));
    if (!decoded) uri.fail("its base64 is damaged; get the file again");
    decoded_.push_back(*std::move(decoded));
    return {decoded_.back().data(), decoded_.back().size()};
  }
  const std::optional<std::string> relative = percent_decoded(text);
  if (!relative) uri.fail("its percent signs are not followed by two digits; export it again");
  return from_file(uri, *relative);
}

/// Only files below the source's folder: a mesh from elsewhere must not make this program read
/// others.
std::string_view GltfFile::from_file(const JsonItem& uri, const std::string& relative) {
  const fs::path name(relative);
  const bool leaves = std::ranges::find(name, fs::path("..")) != name.end();
  const std::size_t colon = relative.find(':');
  const bool scheme = colon != std::string::npos && colon < relative.find('/');
  if (relative.empty() || name.is_absolute() || leaves || scheme)
    uri.fail("the buffer " + in_quotes(relative) +
             " is not in the file's folder or below; put it there, or export as .glb");
  if (source_.directory.empty())
    uri.fail("the buffer " + in_quotes(relative) +
             " needs the file's folder; read the file by its path, not from a pipe, or export as "
             ".glb");
  const fs::path path = source_.directory / name;
  auto found = files_.find(path);
  if (found == files_.end()) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      uri.fail("the file " + in_quotes(path.string()) + " cannot be read; put it beside the scene");
    found = files_.emplace(path, read_file(path)).first;
    bytes_ += found->second.size();
  }
  return {found->second.data(), found->second.size()};
}

void GltfFile::spend(std::uint64_t work) {
  work_ += work;
  if (work > kMaxInteger || work_ > 10'000'000 + 64 * bytes_)
    throw Error(ErrorCode::LimitReached,
                std::string(source_.name) +
                    ": its meshes repeat the same data too often; simplify the scene");
}

std::vector<std::string> GltfFile::take_notes() {
  if (!files_.empty())
    note(counted(files_.size(), "other file was", "other files were") +
         " read besides (first: " + files_.begin()->first.string() + ").");
  return std::move(notes_);
}

std::vector<std::string> GltfFile::other_files() const {
  std::vector<std::string> names;
  for (const auto& [path, bytes] : files_) names.push_back(path.string());
  return names;
}

}  // namespace kaboum::io
