#pragma once

#include <kaboum/certify/sweep.h>

#include <span>
#include <vector>

namespace kaboum::page {

/// PNG with two panels: the bodies where the path begins (blue) and ends (orange), and the set that
/// they sweep, one colour per link.
std::vector<char> picture_of_sweep(const robot::Robot& robot,
                                   std::span<const robot::LinkBody> bodies, const robot::Path& path,
                                   const certify::CertifiedSweep& result);

}  // namespace kaboum::page
