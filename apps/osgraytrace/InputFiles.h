// InputFiles.h - reads the models and the reference of the command line. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Node>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// One file's node, or a group of several. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> readScene(const std::vector<std::string>& files);

/// GL_RGB or GL_RGBA, GL_FLOAT. Throws Failure(kCannotLoad); Failure(kUsage) if its size is another.
osg::ref_ptr<osg::Image> readReference(const std::string& file, int width, int height);

} // namespace osgRayTrace::app
