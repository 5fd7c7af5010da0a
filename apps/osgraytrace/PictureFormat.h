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

/// Returns the format of the path's extension; nothing if no format has it.
std::optional<Format> formatOf(const std::string& path);

/// Returns why no picture of this size can be in such a file, by its extension; empty if it can.
std::string whyNotInFile(const std::string& path, int width, int height);

} // namespace osgRayTrace::app
