// Parameters.h - parameters in the name of a file to ray trace. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>
#include <osgRayTrace/SceneLights>

#include <string>

/// Holds the parts of a name: "cow.osgt.path" is file "cow.osgt" with parameters "path".
struct NameParts
{
    std::string file;
    std::string parameters; ///< without brackets; empty: none
};

/// Splits the name (without ".raytrace") at its last dot that is in no bracket. The text behind the
/// dot is parameters if it stands in () or [], has a '=', or is a single word that applyParameters
/// takes; else it belongs to the file's name, as in "cow.osgt" and "cow.osgt.30,0,0.rot".
NameParts splitName(const std::string& name);

/// Sets options from "path,passes=64": an integrator, a debug channel (which selects the debug
/// integrator) or option=value, separated by commas. Returns an empty string if all went well; else
/// a sentence on the first item that does not fit, and settings have to be thrown away.
/// Lights are set by the names of SceneLights.
std::string applyParameters(const std::string& parameters, osgRayTrace::RayTraceSettings& settings,
                            osgRayTrace::SceneLights& lights);
