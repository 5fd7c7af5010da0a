// PictureFile.h - pictures as files, by their extensions. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Picture.h"

#include <optional>
#include <string>

namespace osgRayTrace::app
{

enum class Format
{
    Exr,
    Png,
    Jpeg,
};

/// By the extension; nothing if it is none of them.
std::optional<Format> formatOf(const std::string& path);

/// Why no picture of this size can be in such a file, by its extension; empty if it can.
std::string whyNotInFile(const std::string& path, int width, int height);

/// By the extension. EXR: radiance and the picture's channels; else the display image. Throws
/// Failure(kCannotWrite).
void writePicture(const std::string& path, const Picture& picture);

} // namespace osgRayTrace::app
