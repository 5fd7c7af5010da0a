// Checkpoint.h - the sums of a picture's passes as a file that any viewer shows. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PassSums>

#include <osg/Vec4>

#include <string>

namespace osgRayTrace::app
{

/// The passes of a picture that are done, and how the picture is shown.
struct Checkpoint
{
    PassSums sums;
    float exposureEv = 0.0f;
    osg::Vec4 clearColor;
    std::string toneCurve = "srgb"; ///< a word of the option
};

/// Writes an OpenEXR file, whole or not at all: R, G, B and A as the picture's, the depth, the sums
/// in further channels. Throws Failure(kCannotWrite).
void writeCheckpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads such a file. Throws Failure(kCannotLoad).
Checkpoint readCheckpoint(const std::string& path);

} // namespace osgRayTrace::app
