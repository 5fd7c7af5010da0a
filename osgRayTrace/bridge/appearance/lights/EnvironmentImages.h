// EnvironmentImages.h - converts osg::Image, flat or as a cube, to an EnvironmentImage. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Environment.h"

#include <osg/Image>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Largest radiance, of a pixel as well as of its product with the scale.
constexpr float kBrightestSky = 1e30f;

/// Counts the pixels in which values were replaced.
struct ReplacedPixels
{
    uint64_t notFinite = 0; ///< pixels replaced by black
    uint64_t negative = 0;  ///< pixels with a negative channel, which became black
    uint64_t tooBright = 0; ///< pixels above 1e30, which became 1e30
};

/// Converts an image by longitude and latitude. Image::getOrigin() is heeded, because no user sets
/// texture coordinates here. Returns null if the format cannot be read, or if there are no pixels
/// or more than 2^28.
std::shared_ptr<const EnvironmentImage>
environmentFromImage(const osg::Image& image, bool decodeSrgb, ReplacedPixels& replaced);

/// Converts six square faces of one size in the order of osg::TextureCubeMap::Face, of 2^25 pixels
/// at most; returns null for other faces.
std::shared_ptr<const EnvironmentImage>
environmentFromCube(const std::vector<const osg::Image*>& faces, bool decodeSrgb,
                    ReplacedPixels& replaced);

/// Returns an environment that visibly stands for an image that cannot be shown: magenta from all
/// around.
std::shared_ptr<const EnvironmentImage> magentaEnvironment();

} // namespace osgRayTrace::engine
