// Picture.h - the results of a render, and the two ways to make them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Camera.h"
#include "Options.h"
#include "Progress.h"

#include <osgRayTrace/Statistics>

#include <osg/Image>
#include <osg/Node>

#include <map>
#include <string>

namespace osgRayTrace::app
{

struct Picture
{
    osg::ref_ptr<osg::Image> radiance; ///< linear, GL_RGBA, GL_FLOAT
    osg::ref_ptr<osg::Image> display;  ///< tone mapped, GL_RGBA, GL_UNSIGNED_BYTE
    std::map<std::string, osg::ref_ptr<osg::Image>> channels; ///< channels that the options ask for
    std::map<std::string, std::string> texts;                 ///< attributes of EXR files
    Statistics statistics;
};

/// Renders with osgRayTrace::Renderer. Throws Failure(kCannotRender).
Picture renderWithoutContext(const Options& options, osg::Node& scene, const Camera& camera,
                             Progress& progress);

/// Renders through a RayTraceDrawable in an OpenGL context. Throws Failure(kCannotRender).
Picture renderInContext(const Options& options, osg::Node& scene, const Camera& camera,
                        Progress& progress);

} // namespace osgRayTrace::app
