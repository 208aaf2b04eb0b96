#pragma once

#include <kaboum/certify/mesh_file.h>

#include <string>

#include "common/cli.h"

/// What bcd-decompose says of a mesh's set, and how it ends.
namespace kaboum::tools {

/// The exit code of a mesh's outcome.
int code_of(const certify::SetCertificate& certificate);

/// What the report says of one mesh: of its certificate, with what reading noted.
Json report_of(const certify::CertifiedFile& made);

}  // namespace kaboum::tools
