// Packages of 3MF: zip archives read with libzip, from memory.

#include "package.h"

#include <kaboum/base/error.h>

#include <algorithm>

#include "xml.h"

namespace kaboum::io {
namespace {

struct CloseEntry {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

Package::Package(const Source& source)
    : source_(source), budget_((16U << 20U) + 64 * std::uint64_t{source.bytes.size()}) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const bytes =
      zip_source_buffer_create(source.bytes.data(), source.bytes.size(), 0, &error);
  if (bytes != nullptr)
    archive_.reset(zip_open_from_source(bytes, ZIP_RDONLY | ZIP_CHECKCONS, &error));
  const std::string reason = archive_ ? "" : zip_error_strerror(&error);
  if (!archive_ && bytes != nullptr) zip_source_free(bytes);
  zip_error_fini(&error);
  if (!archive_)
    fail(source, "not a zip archive, or a damaged one (" + reason + "); get the file again");
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const auto number = static_cast<zip_uint64_t>(i);
    const char* const name = zip_get_name(archive_.get(), number, ZIP_FL_ENC_RAW);
    if (name == nullptr) fail(source, "a part of the package has no name; the file is damaged");
    if (!entries_.emplace(key(name), number).second)
      fail(source, "two parts of the package are named " + in_quotes(name) +
                       "; it is not clear which one is meant");
  }
}

std::string Package::key(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  std::string lower(name);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return lower;
}

std::vector<std::string> Package::parts() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

std::string Package::read(std::string_view name) {
  const auto found = entries_.find(key(name));
  if (found == entries_.end())
    fail(source_, "the package has no part " + in_quotes(name) + "; it is incomplete");
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat_index(archive_.get(), found->second, 0, &status) != 0 ||
      (status.valid & ZIP_STAT_SIZE) == 0)
    fail(source_, "the size of the part " + in_quotes(name) + " is unknown; the file is damaged");
  if (status.size > budget_)
    throw Error(ErrorCode::LimitReached,
                std::string(source_.name) + ": the part " + in_quotes(name) +
                    " inflates to more than 64 times the package; repack it with less compression");
  budget_ -= status.size;
  const std::unique_ptr<zip_file_t, CloseEntry> file(
      zip_fopen_index(archive_.get(), found->second, 0));
  if (!file)
    fail(source_, "the part " + in_quotes(name) + " cannot be opened: " +
                      zip_strerror(archive_.get()) + "; save the package without encryption");
  // One byte more than stated: the checksum is looked at at the end only.
  std::string bytes(status.size + 1, '\0');
  std::size_t size = 0;
  zip_int64_t got = 0;
  do {
    got = zip_fread(file.get(), bytes.data() + size, bytes.size() - size);
    if (got > 0) size += static_cast<std::size_t>(got);
  } while (got > 0 && size < bytes.size());
  if (got < 0 || size != status.size)
    fail(source_, "the part " + in_quotes(name) + " is damaged (" +
                      (got < 0 ? zip_file_strerror(file.get()) : "its size is not the one stated") +
                      "); get the file again");
  bytes.resize(size);
  return bytes;
}

std::string Package::target(std::string_view type) {
  const std::string text = read("_rels/.rels");
  const XmlDocument xml(text, std::string(source_.name) + ": _rels/.rels");
  std::string found;
  xml.each(xml.root(), [&](const tinyxml2::XMLElement& e) {
    if (qualified(e).local != "Relationship") xml.fail_unknown(e);
    if (xml.need(e, "Type") != type) return;
    if (!found.empty()) xml.fail(e, "a second relationship of type " + std::string(type));
    if (attribute(e, "TargetMode").value_or("Internal") != "Internal")
      xml.fail(e, "the model is not in the package; save it as one file");
    found = xml.need(e, "Target");
  });
  if (found.empty()) fail(source_, "the package has no relationship of type " + std::string(type));
  return found;
}

}  // namespace kaboum::io
