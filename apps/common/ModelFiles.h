// ModelFiles.h - reads the models of a command line. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Failure.h"

#include <osg/Node>
#include <osgDB/ReaderWriter>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Returns the node of one file, or a group of those of several. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> readScene(const std::vector<std::string>& files);

/// Returns the node of a text in the format of .osgt files. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> readSceneText(const std::string& text);

/// Returns the failure for a file that osgDB could not read.
Failure cannotLoad(const std::string& file, const osgDB::ReaderWriter::ReadResult& result);

} // namespace osgRayTrace::app
