// DrawnParts.h - parts of a scene that the traced radiance does not hold. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Statistics>

#include <cstdint>
#include <map>
#include <string>

namespace osgRayTrace::app
{

/// Returns the counts of the parts that OSG draws if there is a context, by the keys of
/// Statistics::conversion. What nobody sees, with a context or without, is not among them.
std::map<std::string, uint64_t> drawnParts(const Statistics& statistics);

/// Returns the number of parts of the scene that OSG draws if there is a context, and that nobody
/// draws without one.
uint64_t partsDrawnByOsg(const Statistics& statistics);

/// Returns whether rays meet anything: triangles or volumes.
bool isTraced(const Statistics& statistics);

/// Returns the counts in words: "primitive sets of lines (12), osgText's texts (3)".
std::string inWords(const std::map<std::string, uint64_t>& counts);

} // namespace osgRayTrace::app
