// PictureFormat.h - formats of pictures, by the extensions of their files. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

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

} // namespace osgRayTrace::app
