#pragma once

#include <kaboum/certify/wrap.h>

#include <nlohmann/json.hpp>

// Certificates of wraps as JSON, in reports and in the cache. Internal to kaboum_certify: what is
// read becomes a claim.
namespace kaboum::certify {

nlohmann::ordered_json record_of(const WrapCertificate& wrap);

/// @throws nlohmann::json::exception when it is none of record_of.
WrapCertificate wrap_of(const nlohmann::ordered_json& record);

}  // namespace kaboum::certify
