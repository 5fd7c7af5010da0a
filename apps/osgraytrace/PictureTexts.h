// PictureTexts.h - what a picture says of itself in its file. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Camera.h"
#include "Options.h"

#include <osgRayTrace/Statistics>

#include <map>
#include <string>

namespace osgRayTrace::app
{

/// Returns the attributes of an EXR file: osgRayTrace.version, .integrator, .passes, .seed, .camera
/// (of the whole picture, as options that place it, and crop it) and, if there is one, .error
/// (estimated, relative). Equal pictures have equal texts: the time that they took is not among
/// them. Empty for pictures that are made in parts: --merge makes the same files of sums that do
/// not know all of that.
std::map<std::string, std::string> pictureTexts(const Options& options, const Camera& camera,
                                                const Statistics& statistics);

} // namespace osgRayTrace::app
