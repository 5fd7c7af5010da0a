// Attachments.h - the cameras and lights of nodes. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

#include <osg/Camera>
#include <osg/LightSource>

namespace osgRayTrace::gltf
{

constexpr int kOpenGLLights = 8;

/// Returns a camera that draws nothing: its projection is the file's, its view is that of the
/// place that the node gives it. Applications find it by its name, the node's or its own.
osg::ref_ptr<osg::Camera> readCamera(const Document& document, const JsonPlace& node);

/// Returns a light of KHR_lights_punctual with a number; from kOpenGLLights on it is one that
/// OpenGL does not get. The light's values
/// are such that a traced white surface has the radiance in cd/m^2 that the file's lux and candela
/// give it: an osg::Light of 1 is an irradiance of pi. A range is noted, and light goes on beyond.
osg::ref_ptr<osg::LightSource> readLight(Document& document, const JsonPlace& use, int number);

} // namespace osgRayTrace::gltf
