// PictureFile.h - pictures as files, by their extensions. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Picture.h"
#include "PictureFormat.h"

#include <string>

namespace osgRayTrace::app
{

/// Writes a picture in the format of the extension: EXR gets radiance and the picture's channels,
/// other formats the display image. Throws Failure(kCannotWrite).
void writePicture(const std::string& path, const Picture& picture);

} // namespace osgRayTrace::app
