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

/// Holds the CAVE options of the command line.
struct CaveOptions
{
    std::string file; ///< configuration; empty: no CAVE
    std::string host;
    std::optional<CavePose> head; ///< nothing: the configuration's head
    std::string headPath;         ///< file of poses; empty: the head keeps still
    double time = 0.0;            ///< time of the pictures [s]
    std::string output;           ///< file name for a picture a wall; empty: windows
};

void describeCave(osg::ApplicationUsage& usage);

/// Takes the options off the command line. Throws Failure(kUsage).
CaveOptions readCaveOptions(osg::ArgumentParser& arguments);

/// Shows all that is below root, with scene in it, until the user ends it; or writes the pictures.
/// title: title of the windows. Throws Failure.
int runCave(const CaveOptions& options, osg::Node* root, RayTracedScene* scene,
            const std::string& title);

} // namespace osgRayTrace::app
