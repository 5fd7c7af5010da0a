// Output.h - writes pictures and text files, whole or not at all. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Picture.h"

#include <functional>
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

/// Throws Failure(kCannotWrite) if no file can be created there: better now than after the render.
void checkWritable(const std::string& path);

/// Lets write fill a file beside path, then renames it to path. Whatever write throws leaves path
/// as it was and becomes a Failure(kCannotWrite).
void replaceFile(const std::string& path, const std::function<void(const std::string&)>& write);

/// By the extension. EXR: radiance and the picture's channels; else the display image. Throws
/// Failure(kCannotWrite).
void writePicture(const std::string& path, const Picture& picture);

/// Throws Failure(kCannotWrite).
void writeText(const std::string& path, const std::string& text);

} // namespace osgRayTrace::app
