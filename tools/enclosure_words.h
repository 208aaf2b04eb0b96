#pragma once

#include <kaboum/certify/enclosure.h>

#include <string>

/// Enclosing meshes in words.
namespace kaboum::tools {

/// What was asked for and not reached, and what helps; empty: nothing.
std::string shortfall(const certify::EnclosureCertificate& certificate);

std::string summary(const certify::EnclosureCertificate& certificate);

}  // namespace kaboum::tools
