// ImageConversion.h - osg::Image to OpenEXR channels and back. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

// Both conversions return an empty string, or one sentence that says why there is no result;
// neither throws. OpenEXR's values are linear; bytes are sRGB [IEC61966] from 0 to 1, and their
// alpha is linear.

/// Returns the channels of which toOsgImage makes an image.
const std::vector<std::string>& exrColorChannels();

/// Makes an osg::Image: R, G, B become GL_RGB (a missing one is 0), and Y becomes GL_LUMINANCE,
/// each with A if there is one; A alone becomes GL_ALPHA. type is GL_FLOAT, GL_HALF_FLOAT or
/// GL_UNSIGNED_BYTE.
std::string toOsgImage(const ExrImage& image, GLenum type, osg::ref_ptr<osg::Image>& result);

/// Makes channels of an image of one of these three types. half: the file has 16 bits a value in
/// all channels.
std::string toExrImage(const osg::Image& image, bool half, ExrImage& result);

} // namespace osgRayTrace::engine
