// Reference.h - the picture that --reference names. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <string>

namespace osgRayTrace::app
{

/// Returns the image as GL_RGB or GL_RGBA, GL_FLOAT. Throws Failure(kCannotLoad); Failure(kUsage)
/// if the image has another size.
osg::ref_ptr<osg::Image> readReference(const std::string& file, int width, int height);

} // namespace osgRayTrace::app
