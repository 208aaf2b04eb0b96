// Packages for the tests of 3MF.

#include "package.h"

#include <zip.h>

#include <stdexcept>

namespace kaboum::io::test {

std::string package(const std::vector<std::pair<std::string, std::string>>& parts) {
  zip_source_t* const buffer = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  zip_source_keep(buffer);
  zip_t* const archive = zip_open_from_source(buffer, ZIP_TRUNCATE, nullptr);
  for (const auto& [name, bytes] : parts) {
    zip_source_t* const part = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    const zip_int64_t at = zip_file_add(archive, name.c_str(), part, ZIP_FL_ENC_UTF_8);
    if (at < 0) throw std::runtime_error("zip_file_add");
    // A fixed time: the same bytes in every run.
    zip_file_set_dostime(archive, static_cast<zip_uint64_t>(at), 0, 0x21, 0);
  }
  if (zip_close(archive) != 0) throw std::runtime_error("zip_close");
  std::string result(1U << 20U, '\0');
  zip_source_open(buffer);
  const zip_int64_t size = zip_source_read(buffer, result.data(), result.size());
  zip_source_close(buffer);
  zip_source_free(buffer);
  if (size <= 0 || static_cast<std::size_t>(size) == result.size())
    throw std::runtime_error("zip_source_read");
  result.resize(static_cast<std::size_t>(size));
  return result;
}

std::string three_mf(const std::string& model,
                     std::vector<std::pair<std::string, std::string>> more) {
  more.insert(
      more.begin(),
      {{"[Content_Types].xml",
        R"(<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
        R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
        R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
       {"_rels/.rels",
        R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
        R"(<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)"},
       {"3D/3dmodel.model", model}});
  return package(more);
}

std::string three_mf_mesh(const std::string& x) {
  const std::string next = std::to_string(std::stoi(x) + 1);
  return "<mesh><vertices><vertex x=\"" + x + "\" y=\"0\" z=\"0\"/><vertex x=\"" + next +
         "\" y=\"0\" z=\"0\"/><vertex x=\"" + x + "\" y=\"1\" z=\"0\"/><vertex x=\"" + x +
         "\" y=\"0\" z=\"0.1\"/></vertices>"
         R"(<triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>)"
         R"(<triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh>)";
}

std::string three_mf_model() {
  return "<model " + kCoreSpace + " " + kProductionSpace + "><resources><object id=\"1\">" +
         three_mf_mesh("0") +
         "</object><object id=\"2\"><components><component objectid=\"1\" "
         "transform=\"0 1 0 0 0 1 1 0 0 1 2 3\"/></components></object></resources>"
         "<build><item objectid=\"2\"/><item objectid=\"1\"/></build></model>";
}

}  // namespace kaboum::io::test
