// AddedLights.h - a sky and a sun that the command line adds to models. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <optional>
#include <string>

namespace osgRayTrace::app
{

struct Sun
{
    double azimuthDegrees = 0.0;   ///< clockwise from +y, seen from above, as on a compass
    double elevationDegrees = 0.0; ///< above the horizon
};

struct AddedLights
{
    std::string environment;  ///< image by longitude and latitude; empty: none
    double turnDegrees = 0.0; ///< of the image about +z, anticlockwise seen from above
    double strength = 1.0;    ///< factor of the image's radiance
    std::optional<Sun> sun;

    bool any() const { return !environment.empty() || sun; }
};

/// Returns the scene below a group that also has the lights, or the scene itself if there are none.
/// The sun is a directional osg::Light of white (1, 1, 1) and the name "sun", of the first number
/// that the scene does not use. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::Node> withLights(const osg::ref_ptr<osg::Node>& scene, const AddedLights& lights);

} // namespace osgRayTrace::app
