#pragma once

#include <kaboum/certify/convex_set.h>

// What requests and the records in containers have in common. Internal to kaboum_certify.
namespace kaboum::certify {

/// What a set's container says of where it comes from; claims and distance apart.
geom::Provenance origin_of(const SetRequest& request, const std::string& sha256);

/// What parameters say of regions; empty: there are none.
std::string record_of(const std::vector<geom::RequestedRegion>& regions);

const char* name_of(SetRequest::Direction direction);
const char* name_of(SetRequest::BodyKind kind);
/// What a set of the kind is made of, in words.
const char* plural_of(SetRequest::BodyKind kind);

}  // namespace kaboum::certify
