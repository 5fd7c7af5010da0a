// PictureFormat.cpp - looks extensions up. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PictureFormat.h"

#include "apps/common/ImageFile.h"

#include <osgDB/FileNameUtils>

namespace osgRayTrace::app
{

std::optional<Format> formatOf(const std::string& path)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension == "exr") return Format::Exr;
    if (extension == "png") return Format::Png;
    if (extension == "jpg" || extension == "jpeg") return Format::Jpeg;
    return std::nullopt;
}

std::string whyNotInFile(const std::string& path, int width, int height)
{
    return whyNotInFormat(osgDB::getLowerCaseFileExtension(path), width, height);
}

} // namespace osgRayTrace::app
