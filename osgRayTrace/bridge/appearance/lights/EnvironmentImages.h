// EnvironmentImages.h - from osg::Image, flat or as a cube, to an EnvironmentImage. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Environment.h"

#include <osg/Image>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Radiance that is not surpassed, by a pixel or by what its scale makes of it.
constexpr float kBrightestSky = 1e30f;

/// What was replaced in pixels: each a pixel.
struct ReplacedPixels
{
    uint64_t notFinite = 0; ///< by black
    uint64_t negative = 0;  ///< by black, in the channel that is negative
    uint64_t tooBright = 0; ///< above 1e30, by that
};

/// By longitude and latitude. Image::getOrigin() is heeded: no user sets texture coordinates here.
/// Null if the format cannot be read or there are no pixels, or more than 2^28.
std::shared_ptr<const EnvironmentImage>
environmentFromImage(const osg::Image& image, bool decodeSrgb, ReplacedPixels& replaced);

/// Six square faces of one size in the order of osg::TextureCubeMap::Face, of 2^25 pixels at most;
/// else null.
std::shared_ptr<const EnvironmentImage>
environmentFromCube(const std::vector<const osg::Image*>& faces, bool decodeSrgb,
                    ReplacedPixels& replaced);

/// Stands for an image that cannot be shown, for all to see: magenta from all around.
std::shared_ptr<const EnvironmentImage> magentaEnvironment();

} // namespace osgRayTrace::engine
