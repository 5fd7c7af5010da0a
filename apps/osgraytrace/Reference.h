// Reference.h - the picture that --reference names. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <string>

namespace osgRayTrace::app
{

/// GL_RGB or GL_RGBA, GL_FLOAT. Throws Failure(kCannotLoad); Failure(kUsage) if its size is
/// another.
osg::ref_ptr<osg::Image> readReference(const std::string& file, int width, int height);

} // namespace osgRayTrace::app
