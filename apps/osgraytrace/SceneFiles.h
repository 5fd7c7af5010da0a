// SceneFiles.h - reads the models of the command line. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// One file's node, or a group of several. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> readScene(const std::vector<std::string>& files);

} // namespace osgRayTrace::app
