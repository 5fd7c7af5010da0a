// RgbeConversion.h - osg::Image to Radiance's pixels and back. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/hdr/RgbeImage.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Tells which osg::Image is made of a picture. The names are those of OSG's own plugin.
enum class RgbeKind
{
    Float, ///< GL_RGB, GL_FLOAT: linear radiance
    Bytes, ///< GL_RGB, GL_UNSIGNED_BYTE: radiance times a factor, cut off at 1 ("RGB8")
    Raw,   ///< GL_RGBA, GL_FLOAT: the pixel's four bytes as they are, from 0 to 1 ("RAW")
};

// Both functions return an empty string, or one sentence that says why there is no result; neither
// throws.

/// Makes an osg::Image, row 0 at the bottom. EXPOSURE, COLORCORR and GAMMA of the file are undone;
/// X, Y, Z become linear red, green and blue [IEC61966], and luminance becomes radiance [Ward91];
/// no value is infinite. factor: for RgbeKind::Bytes.
std::string toOsgImage(const RgbeImage& image, RgbeKind kind, float factor,
                       osg::ref_ptr<osg::Image>& result);

/// Takes GL_RGB, GL_RGBA and GL_LUMINANCE of floats; alpha is dropped. Values that are not a number
/// or below 0 become 0, and values above 2^127 become 2^127. raw: does the opposite of
/// RgbeKind::Raw, and takes bytes as well.
std::string toRgbeImage(const osg::Image& image, bool raw, RgbeImage& result);

} // namespace osgRayTrace::engine
