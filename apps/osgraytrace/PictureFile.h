// PictureFile.h - pictures as files, by their extensions. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Picture.h"
#include "PictureFormat.h"

#include <string>

namespace osgRayTrace::app
{

/// By the extension. EXR: radiance and the picture's channels; else the display image. Throws
/// Failure(kCannotWrite).
void writePicture(const std::string& path, const Picture& picture);

} // namespace osgRayTrace::app
