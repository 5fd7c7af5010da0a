// ViewText.h - a view as options of the command line, and back. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "StoredView.h"

#include <osg/Matrixd>

#include <optional>
#include <string>

namespace osgRayTrace::app
{

/// What options say of a view; the rest is as the scene has it.
struct ViewOptions
{
    std::optional<osg::Vec3d> eye, center, up;
    std::optional<double> fovyDegrees; ///< vertical
    std::optional<double> height;      ///< of what a parallel view shows

    bool any() const { return eye || center || up || fovyDegrees || height; }
};

/// Returns "--eye X Y Z --center X Y Z --up X Y Z --fovy DEGREES", or --parallel HEIGHT for
/// parallel views.
std::string viewText(const osg::Matrixd& view, const osg::Matrixd& projection);

/// Returns a placement with the values of the options in place of its own.
Placement withOptions(const Placement& placement, const ViewOptions& options);

/// Reads such options from a file. Throws Failure(kCannotLoad).
ViewOptions readViewFile(const std::string& file);

} // namespace osgRayTrace::app
