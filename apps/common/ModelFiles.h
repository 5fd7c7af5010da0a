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

/// One file's node, or a group of several. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> readScene(const std::vector<std::string>& files);

/// What to throw for a file that osgDB could not read.
Failure cannotLoad(const std::string& file, const osgDB::ReaderWriter::ReadResult& result);

} // namespace osgRayTrace::app
