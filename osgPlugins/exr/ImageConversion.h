// ImageConversion.h - osg::Image to OpenEXR channels and back. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

// Both return an empty string, or one sentence that says why there is no result; none throws.
// OpenEXR's values are linear; bytes are sRGB [IEC61966] from 0 to 1, their alpha is linear.

/// The channels of which toOsgImage makes an image.
const std::vector<std::string>& exrColorChannels();

/// R, G, B become GL_RGB (a missing one is 0), Y GL_LUMINANCE, each with A if there is one; A alone
/// GL_ALPHA. type is GL_FLOAT, GL_HALF_FLOAT or GL_UNSIGNED_BYTE.
std::string toOsgImage(const ExrImage& image, GLenum type, osg::ref_ptr<osg::Image>& result);

/// Takes images of these three types. half: of all channels in the file.
std::string toExrImage(const osg::Image& image, bool half, ExrImage& result);

} // namespace osgRayTrace::engine
