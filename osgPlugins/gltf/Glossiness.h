// Glossiness.h - the roughness that a glossiness texture means. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Texture2D>

namespace osgRayTrace::gltf
{

/// Returns a texture whose green is one minus the factor times the alpha of another texture, with
/// its sampler; null if that texture has no image of four bytes a pixel.
osg::ref_ptr<osg::Texture2D> roughnessOf(const osg::Texture2D& glossiness, float factor);

} // namespace osgRayTrace::gltf
