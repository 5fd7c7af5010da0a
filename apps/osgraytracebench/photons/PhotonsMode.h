// PhotonsMode.h - speed of photon maps, and the error that photons leave. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

struct PhotonsOptions
{
    int width = 256;      ///< width of the pictures, which are square [pixels]; 0: no pictures
    double longest = 4.0; ///< longest budget of a picture [s]
    int seeds = 2;        ///< pictures of each method
    double referenceSeconds = 60.0;                 ///< seconds for a reference that is rendered
    std::string referenceA, referenceB, referenceC; ///< files; empty: rendered
    std::string only; ///< part of the names of rows that are measured; empty: all
    int runs = 9;     ///< timings of each rate; the median counts
    int photons =
        1000000; ///< photons for look-ups and building; tracing emits about a quarter of it
};

/// Measures look-ups and building against a plain grid, the time of beams in media, tracing against
/// Embree alone on the same rays, and error against time of all methods with photons, and of path
/// tracing. Throws app::Failure.
void measurePhotons(const PhotonsOptions& options, Rows& rows);

/// Measures one part of measurePhotons, as the next three functions do.
void measurePhotonLookups(const PhotonsOptions& options, Rows& rows);
void measurePhotonBeams(const PhotonsOptions& options, Rows& rows);
void measurePhotonRays(const PhotonsOptions& options, Rows& rows);
void measurePhotonErrors(const PhotonsOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
