#pragma once

#include <kaboum/certify/convex_set.h>

#include <string>
#include <string_view>

// Certificates in the cache. Internal to kaboum_certify: what is read becomes a claim.
namespace kaboum::certify {

/// One line of JSON, without claims.
std::string write_record(const SetCertificate& certificate);

/// @throws Error{InvalidInput} when the text is none of write_record.
SetCertificate read_record(std::string_view text);

}  // namespace kaboum::certify
