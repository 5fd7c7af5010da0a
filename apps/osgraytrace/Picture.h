// Picture.h - the results of a render, and the two ways to make them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Camera.h"
#include "Options.h"
#include "Progress.h"
#include "TimedScene.h"

#include <osgRayTrace/Renderer>

#include <osg/Image>
#include <osg/Node>

#include <map>
#include <string>

namespace osgRayTrace::app
{

/// The part of a picture that the options ask for.
PictureWindow windowOf(const Options& options);

struct Picture
{
    osg::ref_ptr<osg::Image> radiance; ///< linear, GL_RGBA, GL_FLOAT
    osg::ref_ptr<osg::Image> display;  ///< tone mapped, GL_RGBA, GL_UNSIGNED_BYTE
    osg::ref_ptr<osg::Image> straight; ///< display with alpha, for .png; null: none is wanted
    std::map<std::string, osg::ref_ptr<osg::Image>> channels; ///< channels that the options ask for
    std::map<std::string, std::string> texts;                 ///< attributes of EXR files
    Statistics statistics;
    int code = 0; ///< exit code of what failed beside the picture, which is whole
};

/// Renders with osgRayTrace::Renderer. Throws Failure(kCannotRender).
Picture renderWithoutContext(const Options& options, TimedScene& shown, const Camera& camera,
                             Progress& progress);

class Group;

/// Renders with osgRayTrace::Renderer as rank 0 of a group. Throws Failure.
Picture renderInGroup(const Options& options, TimedScene& shown, const Camera& camera,
                      Progress& progress, Group& group);

/// Makes passes for rank 0 of the group, till it wants no more.
void helpInGroup(const Options& options, TimedScene& shown, const Camera& camera, Group& group);

/// Does the same with the scene that rank 0 sends; options describe no scene then.
void helpWithoutModel(Options options, Group& group);

/// Returns a renderer of the scene for the options, which are valid as long as it renders.
osg::ref_ptr<Renderer> newRenderer(const Options& options, TimedScene& shown, const Camera& camera);

/// Returns the images and channels of a renderer that has rendered. Throws Failure(kCannotRender).
Picture pictureOf(const Renderer& renderer, const Options& options);

/// Renders through a RayTraceDrawable in an OpenGL context. Throws Failure(kCannotRender).
Picture renderInContext(const Options& options, osg::Node& scene, const Camera& camera,
                        Progress& progress);

} // namespace osgRayTrace::app
