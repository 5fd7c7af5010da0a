// MissingImages.h - tells images whose files could not be read. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Returns whether an image has nothing but the name of its file. osgDB leaves such images if the
/// option ForceReadingImage asks for it, and null otherwise.
inline bool isMissing(const osg::Image* image)
{
    return image && !image->data() && image->s() == 0 && !image->getFileName().empty();
}

} // namespace osgRayTrace::engine
