// CaveViewer.h - a scene on the walls of a CAVE, in windows or as pictures. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveSetup.h"
#include "apps/cave/HeadPath.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/ApplicationUsage>
#include <osg/ArgumentParser>

#include <optional>
#include <string>

namespace osgRayTrace::app
{

/// Of the command line.
struct CaveOptions
{
    std::string file; ///< empty: no CAVE
    std::string host;
    std::optional<CavePose> head; ///< else the configuration's
    std::string headPath;         ///< file; empty: the head keeps still
    double time = 0.0;            ///< of pictures [s]
    std::string output;           ///< a picture a wall; empty: windows
};

void describeCave(osg::ApplicationUsage& usage);

/// Takes the options off the command line. Throws Failure(kUsage).
CaveOptions readCaveOptions(osg::ArgumentParser& arguments);

/// Shows what is below root, with scene in it, until the user ends it; or writes the pictures.
/// title: of the windows. Throws Failure.
int runCave(const CaveOptions& options, osg::Node* root, RayTracedScene* scene,
            const std::string& title);

} // namespace osgRayTrace::app
