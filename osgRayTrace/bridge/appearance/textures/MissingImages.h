// MissingImages.h - images whose files could not be read. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Whether there is nothing of an image but the name of its file. osgDB leaves such images where
/// the option ForceReadingImage asks for it, and null otherwise.
inline bool isMissing(const osg::Image* image)
{
    return image && !image->data() && image->s() == 0 && !image->getFileName().empty();
}

} // namespace osgRayTrace::engine
