// ImageFile.h - images as files; errors of libpng and libjpeg end no process. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <string>

namespace osgRayTrace::app
{

/// Returns why no image of this size can be in a file of this extension ("png", "jpg", ...); empty
/// if it can.
std::string whyNotInFormat(const std::string& extension, int width, int height);

/// Writes an image, row 0 at the bottom, to a file, whole or not at all, in the format of the
/// extension. PNG and JPEG get the colours of GL_RGB or GL_RGBA, GL_UNSIGNED_BYTE, by libpng and
/// libjpeg: OSG's plugins let errors of these libraries end the process. Alpha is left out, unless
/// a PNG keeps it, which has to be straight. Other formats are left to the plugins. Throws
/// Failure(kCannotWrite).
void writeImageFile(const std::string& path, const osg::Image& image, bool keepsAlpha = false);

} // namespace osgRayTrace::app
