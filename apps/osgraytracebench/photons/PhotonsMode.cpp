// PhotonsMode.cpp - runs the parts of the mode. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/photons/PhotonsMode.h"

#include "apps/common/Failure.h"

namespace osgRayTrace::bench
{

void measurePhotons(const PhotonsOptions& options, Rows& rows)
{
    const auto wanted = [&](const std::string& part)
    { return part.find(options.only) != std::string::npos; };
    if (!wanted("lookup") && !wanted("beams") && !wanted("tracing") && !wanted("error"))
        throw app::Failure(app::kUsage, "--only " + options.only + ": no part has this name");
    if (wanted("lookup")) measurePhotonLookups(options, rows);
    if (wanted("beams")) measurePhotonBeams(options, rows);
    if (wanted("tracing")) measurePhotonRays(options, rows);
    if (wanted("error") && options.width > 0) measurePhotonErrors(options, rows);
}

} // namespace osgRayTrace::bench
