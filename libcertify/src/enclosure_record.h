#pragma once

#include <kaboum/certify/enclosure.h>

#include <string>
#include <string_view>

// Certificates of enclosing meshes in the cache. Internal to kaboum_certify: what is read becomes a
// claim.
namespace kaboum::certify {

/// One line of JSON.
std::string write_enclosure(const EnclosureCertificate& certificate);

/// @throws Error{InvalidInput} when the text is none of write_enclosure.
EnclosureCertificate read_enclosure(std::string_view text);

}  // namespace kaboum::certify
