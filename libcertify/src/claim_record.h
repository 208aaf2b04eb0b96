#pragma once

#include <kaboum/certify/certificate.h>

#include <nlohmann/json.hpp>

// Claims in records and reports. Internal to kaboum_certify.
namespace kaboum::certify {

nlohmann::ordered_json record_of(const Claim& claim);

}  // namespace kaboum::certify
