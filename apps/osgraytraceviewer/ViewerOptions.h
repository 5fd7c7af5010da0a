// ViewerOptions.h - where the viewer begins, and how it moves. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/common/Backdrop.h"
#include "apps/common/ViewText.h"

#include <osgRayTrace/SceneLights>

#include <osg/AnimationPath>
#include <osg/ArgumentParser>
#include <osgViewer/Viewer>

#include <string>

namespace osgRayTrace::app
{

struct ViewerOptions
{
    std::string camera; ///< name of a camera of the model, or a file; empty: none
    ViewOptions view;
    osg::ref_ptr<osg::AnimationPath> path; ///< null: none is played
    SceneLights lights;
    Backdrop backdrop; ///< behind the models, in place of the clear colour
};

void describeView(osg::ApplicationUsage& usage);

/// Reads the options. Throws Failure.
ViewerOptions readViewerOptions(osg::ArgumentParser& arguments);

/// Gives the viewer osgviewer's manipulators on the keys 1 to 6, and 8 for a path, which is played
/// from the beginning.
void addManipulators(osgViewer::Viewer& viewer, const ViewerOptions& options);

/// Shows the view that the options ask for, else the one that the scene brings, if there is one.
/// Throws Failure(kUsage).
void showView(osgViewer::Viewer& viewer, osg::Node& scene, const ViewerOptions& options);

} // namespace osgRayTrace::app
